"""A window that shows pictures, by GLFW and OpenGL, which come with MuJoCo."""

import time
import warnings

import glfw
import mujoco
import numpy as np
from jaxtyping import UInt8

from mjdrive.errors import RenderError


def require_display() -> None:
    """Make sure that a window can be opened; MuJoCo's viewer would end the whole process.

    Raises:
        RenderError: If there is no display.
    """
    with warnings.catch_warnings(record=True) as complaints:
        warnings.simplefilter("always")
        works = glfw.init()
    if not works:
        reasons = "; ".join(str(complaint.message) for complaint in complaints)
        raise RenderError(
            f"No window can be opened here ({reasons or 'GLFW does not start'}). Expected a display: work on a desktop, "
            "or log in with `ssh -X`; pictures without one: render_mode='rgb_array', `mjdrive drive`."
        )


class Window:
    """Shows pictures of one size, no faster than they were taken.

    Args:
        title: Shown above.
        width: Of the pictures [px].
        height: Of the pictures [px].
        interval: Least time between two pictures [s].

    Raises:
        RenderError: If there is no display.
    """

    def __init__(self, title: str, *, width: int, height: int, interval: float) -> None:
        require_display()
        glfw.default_window_hints()
        glfw.window_hint(glfw.RESIZABLE, glfw.FALSE)
        self._window = glfw.create_window(width, height, title, None, None)
        if not self._window:
            raise RenderError(
                "The display opens no window with OpenGL; expected one that does. Use render_mode='rgb_array'."
            )
        glfw.make_context_current(self._window)
        model = mujoco.MjModel.from_xml_string("<mujoco/>")  # a context wants one
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        self._interval, self._next = interval, time.monotonic()

    def show(self, picture: UInt8[np.ndarray, "H W 3"]) -> None:
        """Show a picture and wait until the next one is due.

        Args:
            picture: Red, green, blue, top row first [-].
        """
        glfw.make_context_current(self._window)
        rectangle = mujoco.MjrRect(0, 0, *glfw.get_framebuffer_size(self._window))
        mujoco.mjr_drawPixels(np.flipud(picture).ravel(), None, rectangle, self._context)
        glfw.swap_buffers(self._window)
        glfw.poll_events()
        time.sleep(max(0.0, self._next - time.monotonic()))
        self._next = time.monotonic() + self._interval

    def close(self) -> None:
        """Close the window."""
        glfw.make_context_current(self._window)
        self._context.free()
        glfw.destroy_window(self._window)
