"""Finds an OpenGL that draws without a display.

MuJoCo chooses its backend from MUJOCO_GL when it is imported, which is too early here: whoever only simulates must
need no OpenGL at all. So the context is made here, when the first picture is asked for.
"""

import ctypes.util
import importlib
import os
import platform
from typing import Protocol, runtime_checkable

from mjdrive.errors import RenderError

_LIBRARIES = {"egl": "EGL", "osmesa": "OSMesa"}
_REMEDY = "On Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri libopengl0 (or libosmesa6, and set MUJOCO_GL=osmesa)."


@runtime_checkable
class OpenGlContext(Protocol):
    """What MuJoCo's backends have in common."""

    def make_current(self) -> None:
        """Send drawing commands of this thread here."""

    def free(self) -> None:
        """Give the memory back."""


def choose_backend() -> str:
    """Choose how to draw: what MUJOCO_GL asks for, else the first of EGL and OSMesa that is installed.

    Returns:
        "egl", "osmesa", "glfw" or "cgl".

    Raises:
        RenderError: If MUJOCO_GL forbids rendering or names no backend, or if there is no OpenGL.
    """
    asked = os.environ.get("MUJOCO_GL", "").lower().strip()
    if asked in ("egl", "osmesa", "glfw", "cgl"):
        return asked
    if asked in ("disable", "disabled", "off", "false", "0"):
        raise RenderError(
            f"MUJOCO_GL={asked} forbids pictures; unset it, or set it to egl or osmesa."
        )
    if platform.system() == "Darwin":
        return "cgl"
    for backend, library in _LIBRARIES.items():
        if ctypes.util.find_library(library):
            return backend
    raise RenderError(f"No OpenGL found (looked for EGL and OSMesa); pictures need one. {_REMEDY}")


def open_context(width: int, height: int) -> OpenGlContext:
    """Open a context and make it current.

    Args:
        width: Widest picture [px].
        height: Highest picture [px].

    Returns:
        Context of the chosen backend.

    Raises:
        RenderError: If the backend does not work on this machine.
    """
    backend = choose_backend()
    try:
        module = importlib.import_module(f"mujoco.{backend}")
        context: OpenGlContext = module.GLContext(width, height)
        context.make_current()
    except (ImportError, RuntimeError, AttributeError, OSError) as error:
        raise RenderError(
            f"OpenGL backend '{backend}' does not work here: {error}. {_REMEDY}"
        ) from error
    return context
