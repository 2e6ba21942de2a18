"""MuJoCo's warnings, kept out of the user's folder.

Left alone, MuJoCo appends its warnings to MUJOCO_LOG.TXT in the working folder. Importing this module sends them to the
log instead. That hook is one for the whole process, and other packages (dm_control) take it over, so what went wrong is
read from the simulation itself.
"""

import logging

import mujoco

from mjdrive.errors import PhysicsError

_LOGGER = logging.getLogger(__name__)

# What leaves the state of a simulation worthless; MuJoCo itself resets the data and goes on.
_FATAL = (
    mujoco.mjtWarning.mjWARN_INERTIA,
    mujoco.mjtWarning.mjWARN_CONTACTFULL,
    mujoco.mjtWarning.mjWARN_CNSTRFULL,
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
    mujoco.mjtWarning.mjWARN_BADCTRL,
)


def _log(message: str) -> None:
    _LOGGER.warning(message)


mujoco.set_mju_user_warning(_log)


def num_warnings(data: mujoco.MjData) -> int:
    """How often MuJoCo has warned in a simulation since it was reset [-]."""
    return int(data.warning.number.sum())


def require_sane(data: mujoco.MjData) -> None:
    """Refuse a simulation that MuJoCo has given up.

    Args:
        data: Simulation that has been stepped.

    Raises:
        PhysicsError: If MuJoCo met values that are not numbers, or ran out of memory for contacts.
    """
    counts = data.warning.number
    if not counts.any():
        return
    broken = [kind.name for kind in _FATAL if counts[kind]]
    if broken:
        raise PhysicsError(
            f"The physics broke at {data.time:.3f} s ({', '.join(broken)}); expected finite motion. "
            f"Take a shorter timestep, or restore an earlier state."
        )
