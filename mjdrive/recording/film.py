"""A drive as a video: what the cameras see, what the policy sees and thinks of it, and where the car is, in one frame."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.colors import to_rgb

from mjdrive.bev import picture as bev_picture
from mjdrive.bev.picture import Rgb
from mjdrive.config import BevConfig, CameraConfig
from mjdrive.datatypes import Episode, Infraction, Observation
from mjdrive.evaluation.figure_style import SYMBOLS, title
from mjdrive.recording.pages import GAP, HEAD, LABEL, Page
from mjdrive.recording.panels import PANEL, landscape_panel, town_panel
from mjdrive.recording.playback import Playback
from mjdrive.simulation.front_cameras import FrontCameras

FRAMES_PER_SECOND = 10
"""One frame a decision: videos run as fast as the car [1/s]."""

TOLD_FOR = 2.0
"""An infraction is written above the map for so long [s]."""

BAR = 10
"""Height of the bar that shows how far the video is [px]."""

Landscape = Callable[[Observation], Float[np.ndarray, "A S"]]
"""What a policy thinks of all actions: probabilities of an even grid of them, acceleration outermost [-]."""


def frames(
    playback: Playback,
    *,
    landscape: Landscape | None = None,
    cameras: bool = True,
    on_frame: Callable[[int], None] = lambda done: None,
) -> Iterator[UInt8[np.ndarray, "H W 3"]]:
    """Draw an episode frame by frame.

    Args:
        playback: The episode.
        landscape: Asks the policy what it thinks of all actions; None where there is nobody to ask.
        cameras: Whether the front cameras are shown, which needs OpenGL.
        on_frame: Told the number of frames drawn.

    Yields:
        RGB pictures of one even size.

    Raises:
        RenderError: If cameras are asked for and there is no OpenGL here.
    """
    config = CameraConfig(width_px=PANEL, height_px=PANEL * 9 // 16)
    episode = playback.episode
    top = HEAD + cameras * (config.height_px + LABEL)
    height = top + LABEL + PANEL + GAP + BAR + GAP
    page = Page(3 * PANEL + 4 * GAP, height + height % 2, title(episode))
    marks = _marks(episode)
    with ExitStack() as stack:
        eyes = stack.enter_context(FrontCameras(playback.simulation, config)) if cameras else None
        for step in range(len(episode.time)):
            playback.show(step)
            if eyes is not None:
                page.put_row(HEAD, list(eyes.render()), ("half left", "ahead", "half right"))
            page.put_row(top, _panels(playback, step, landscape), _labels(episode, step, landscape))
            share = (step + 1) / len(episode.time)
            page.put_bar(top + LABEL + PANEL + GAP, share, marks, height=BAR)
            yield page.picture
            on_frame(step + 1)


def _panels(
    playback: Playback, step: int, landscape: Landscape | None
) -> tuple[UInt8[np.ndarray, "P P 3"], ...]:
    episode, simulation = playback.episode, playback.simulation
    seen, config = playback.observe(), BevConfig()
    scale = PANEL // config.size_px
    thought = None if landscape is None else landscape(seen)
    return (
        bev_picture.picture(seen.bev, config, simulation.car.parameters, scale=scale),
        landscape_panel(thought, episode.labels[step]),
        town_panel(
            simulation.town,
            episode.vehicle[: step + 1],
            _so_far(episode, step),
            clock=simulation.time + episode.light_phase,
        ),
    )


def _labels(episode: Episode, step: int, landscape: Landscape | None) -> tuple[str, str, str]:
    now = float(episode.time[step])
    told = [it for it in _so_far(episode, step) if now - it.time < TOLD_FOR]
    where = f"{now:.1f} s, {3.6 * episode.vehicle[step, 3]:.0f} km/h"
    if told:
        where = f"{where}: {SYMBOLS[told[-1].kind][0]}"
    return (
        "what it sees",
        "energy; ring: action chosen, left is left, up is throttle"
        if landscape is not None
        else "action chosen; left is left, up is throttle",
        where,
    )


def _so_far(episode: Episode, step: int) -> tuple[Infraction, ...]:
    return tuple(it for it in episode.infractions if it.time <= episode.time[step] + 1e-9)


def _marks(episode: Episode) -> list[tuple[float, Rgb]]:
    """Where on the bar the infractions are, and their colours."""
    first, whole = float(episode.time[0]), max(len(episode.time), 1)
    interval = FRAMES_PER_SECOND**-1
    marks = []
    for it in episode.infractions:
        red, green, blue = (round(255 * part) for part in to_rgb(SYMBOLS[it.kind][2]))
        marks.append((min((it.time - first) / interval / whole, 1.0), (red, green, blue)))
    return marks
