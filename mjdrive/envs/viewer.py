"""MuJoCo's own viewer on a drive, for contacts and forces."""

import time

import mujoco
import mujoco.viewer

from mjdrive.envs.window import require_display
from mjdrive.simulation.simulation import Simulation


class ViewerClosedError(Exception):
    """Somebody has closed the window, which ends the drive."""


class Viewer:
    """Shows a simulation while somebody drives it, no faster than the clock.

    Args:
        simulation: What to show.
        contacts: Whether contact points and forces are shown from the beginning.

    Raises:
        RenderError: If there is no display.
    """

    def __init__(self, simulation: Simulation, *, contacts: bool = True) -> None:
        require_display()
        self._interval = simulation.config.control_interval
        self._handle = mujoco.viewer.launch_passive(simulation.model, simulation.data)
        self._next = time.monotonic()
        with self._handle.lock():
            for flag in (
                mujoco.mjtVisFlag.mjVIS_CONTACTPOINT,
                mujoco.mjtVisFlag.mjVIS_CONTACTFORCE,
            ):
                self._handle.opt.flags[flag] = contacts
            self._handle.cam.type = mujoco.mjtCamera.mjCAMERA_TRACKING
            self._handle.cam.trackbodyid = simulation.model.body("car").id
            self._handle.cam.distance, self._handle.cam.elevation = 14.0, -25.0

    def show(self) -> None:
        """Show the simulation as it is now, and wait until the next control step is due.

        Raises:
            ViewerClosedError: If the window has been closed.
        """
        if not self._handle.is_running():
            raise ViewerClosedError
        self._handle.sync()
        time.sleep(max(0.0, self._next - time.monotonic()))
        self._next = time.monotonic() + self._interval

    def close(self) -> None:
        """Close the window."""
        self._handle.close()
