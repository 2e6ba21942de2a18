"""MuJoCo's warnings, kept out of the user's folder.

Left alone, MuJoCo appends its warnings to MUJOCO_LOG.TXT in the working folder. Importing this module sends them here
instead; the hook is global in MuJoCo and so is the count.
"""

from collections import Counter
from collections.abc import Mapping
from types import MappingProxyType

import mujoco

from mjdrive.errors import PhysicsError

_COUNTS: Counter[str] = Counter()

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


def _record(message: str) -> None:
    _COUNTS[message.partition(" Time =")[0]] += 1


mujoco.set_mju_user_warning(_record)


def warning_counts() -> Mapping[str, int]:
    """How often MuJoCo has said what in this process, by message."""
    return MappingProxyType(_COUNTS)


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
