"""`--video`: a drive as an H.264 video, with what its policy thinks where it can be asked."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from mjdrive.cli.console import progress_bars
from mjdrive.cli.driver import Driver
from mjdrive.files import write_atomically
from mjdrive.recording import film, mp4
from mjdrive.recording.playback import Playback
from mjdrive.simulation import opengl

if TYPE_CHECKING:
    from mjdrive.recording.film import Landscape

VIDEO = "drive.mp4"
"""Name of the video in the folder of a drive."""

POINTS = 33
"""Grid points of the landscapes along each action component [-]; they are drawn smoothly between them."""


def require_cameras() -> None:
    """Make sure that the cameras can draw, before anything long begins.

    Raises:
        RenderError: If there is no OpenGL here.
    """
    opengl.open_context(16, 16).free()


def landscape_of(driver: Driver) -> "Landscape | None":
    """What a driver thinks of all actions, for those that can be asked: trained policies."""
    from mjdrive.learning.pilot import Pilot
    from mjdrive.study.jobs.landscapes import probabilities

    pilot = driver.pilot
    if not isinstance(pilot, Pilot):
        return None
    return lambda seen: probabilities(pilot.learner, seen, points=POINTS)


def write_video(
    playback: Playback, path: Path, *, landscape: "Landscape | None", cameras: bool = True
) -> None:
    """Write an episode as a video, with a bar.

    Args:
        playback: The episode.
        path: MP4 file to write.
        landscape: Asks the policy what it thinks, or None.
        cameras: Whether the front cameras are shown.

    Raises:
        RenderError: If cameras are asked for and there is no OpenGL here.
    """
    with progress_bars() as bars:
        task = bars.add_task("video", total=len(playback.episode.time), unit="frames")
        on_frame: Callable[[int], None] = lambda done: bars.update(task, completed=done)  # noqa: E731
        pictures = film.frames(playback, landscape=landscape, cameras=cameras, on_frame=on_frame)
        write_atomically(path, mp4.encode(pictures, frames_per_second=film.FRAMES_PER_SECOND))
