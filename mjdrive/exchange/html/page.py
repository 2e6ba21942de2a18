"""Episode -> one HTML file that plays it: the live page with the episode inside, which needs no server and no network."""

import base64
import html
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mjdrive.datatypes import Episode
from mjdrive.evaluation.figure_style import title
from mjdrive.exchange.views import ViewMaker
from mjdrive.files import write_atomically
from mjdrive.page import built, wire
from mjdrive.page.replaying import episode_message
from mjdrive.page.scene import scene_message
from mjdrive.recording.playback import car_of, town_of
from mjdrive.simulation.simulation import Simulation

HEIGHT_PX = 820
"""Of the frame in a notebook [px]."""

_COMPRESSION = 9


class EpisodePage:
    """The page of one drive; the last expression of a notebook's cell shows it.

    Args:
        episode: The drive.
        car: Name or MJCF file of the car; what the episode says if None.
        on_step: Told the number of steps drawn.

    Attributes:
        text: The whole page.

    Raises:
        DataError: If town or car are not those of the episode.
        RenderError: If the live page was never built, as in a checkout whose built page was deleted.
    """

    def __init__(
        self,
        episode: Episode,
        *,
        car: str | None = None,
        on_step: Callable[[int], None] = lambda done: None,
    ) -> None:
        built.require_built()
        self.text = built.with_drive(_drive(episode, car, on_step))

    def save(self, path: Path) -> None:
        """Write the page; a file of that name is replaced."""
        write_atomically(path, self.text.encode())

    def _repr_html_(self) -> str:
        """What a notebook shows: the page in a frame of its own."""
        return (
            f'<iframe title="episode" sandbox="allow-scripts" width="100%" height="{HEIGHT_PX}" '
            f'style="border:0" srcdoc="{html.escape(self.text, quote=True)}"></iframe>'
        )


def _drive(episode: Episode, car: str | None, on_step: Callable[[int], None]) -> dict[str, Any]:
    """What the page reads: the messages that a server would send it, as text."""
    town, driven = town_of(episode), car_of(episode, name=car)
    views, seen = ViewMaker(town), []
    for step in range(len(episode.time)):
        blobs = {"bev": views.bev(episode, step)}
        seen.append(_text(wire.pack("view", {"step": step}, blobs, level=_COMPRESSION)))
        on_step(step + 1)
    scene = scene_message(town, Simulation(town, car=driven).model)
    name = title(episode)
    return {
        "title": name,
        "scene": _text(wire.deflated(scene, level=_COMPRESSION)),
        "episode": _text(
            wire.deflated(episode_message(episode, name, car=driven), level=_COMPRESSION)
        ),
        "views": seen,
    }


def _text(message: bytes) -> str:
    return base64.b64encode(message).decode()
