"""Episode -> one HTML file that plays it: map, bird's-eye view, speed, actions and infractions, without any network."""

import base64
import html
import json
import zlib
from collections.abc import Callable
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from mjdrive.bev.layers import pack
from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation.figure_style import SYMBOLS, title
from mjdrive.exchange.views import ViewMaker
from mjdrive.files import write_atomically
from mjdrive.recording.playback import car_of, town_of
from mjdrive.town import signals
from mjdrive.town.surface import edges
from mjdrive.vehicle.parameters import VehicleParameters

HEIGHT_PX = 760
"""Of the frame in a notebook [px]."""

_FORMAT = "mjdrive-page-1"
_OUTLINE_STEP = 2.0  # between the points of a lane on the map [m]
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
    """

    def __init__(
        self,
        episode: Episode,
        *,
        car: str | None = None,
        on_step: Callable[[int], None] = lambda done: None,
    ) -> None:
        town, parameters = town_of(episode), car_of(episode, name=car).parameters
        data = _data(episode, town, parameters, on_step)
        here = resources.files(__package__)
        style, script, page = (
            (here / f"episode.{kind}").read_text(encoding="utf-8")
            for kind in ("css", "js", "html.jinja")
        )
        # "<" must not end the element that holds the data.
        packed = json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
        template = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
        self.text = template.from_string(page).render(
            title=title(episode), style=style, script=script, data=packed
        )

    def save(self, path: Path) -> None:
        """Write the page; a file of that name is replaced."""
        write_atomically(path, self.text.encode())

    def _repr_html_(self) -> str:
        """What a notebook shows: the page in a frame of its own."""
        return (
            f'<iframe title="episode" sandbox="allow-scripts" width="100%" height="{HEIGHT_PX}" '
            f'style="border:0" srcdoc="{html.escape(self.text, quote=True)}"></iframe>'
        )


def _data(
    episode: Episode,
    town: Town,
    parameters: VehicleParameters,
    on_step: Callable[[int], None],
) -> dict[str, Any]:
    """All that the script of the page reads, as JSON values."""
    config, views = BevConfig(), ViewMaker(town)
    packed = []
    for step in range(len(episode.time)):
        codes = pack(views.bev(episode, step)).tobytes()
        packed.append(base64.b64encode(zlib.compress(codes, _COMPRESSION)).decode())
        on_step(step + 1)
    ahead = config.pixels_per_metre * config.origin_ahead_of_rear_axle
    rear = config.size_px - config.ego_above_bottom_px + ahead
    return {
        "format": _FORMAT,
        "time": _rounded(episode.time, 3),
        "path": _rounded(episode.vehicle[:, :3], 3),
        "speed": _rounded(episode.vehicle[:, 3], 3),
        "actions": _rounded(episode.actions, 4),
        "infractions": [_infraction(it) for it in episode.infractions],
        "views": packed,
        "view": {
            "size": config.size_px,
            "scale": config.pixels_per_metre,
            "rear": rear,
            "length": parameters.length,
            "width": parameters.width,
            "overhang": parameters.rear_overhang,
        },
        "town": {
            "bounds": _rounded(town.bounds, 2),
            "lanes": [_outline(*edges(lane)) for lane in town.lanes.values()],
            "lights": _lights(episode, town),
        },
    }


def _infraction(it: Any) -> dict[str, Any]:
    words, _, colour = SYMBOLS[it.kind]
    return {
        "time": round(it.time, 3),
        "x": round(it.x, 3),
        "y": round(it.y, 3),
        "words": words,
        "cause": it.cause,
        "colour": colour,
    }


def _outline(left: np.ndarray, right: np.ndarray) -> list[Any]:
    """Left edge forwards, right edge back, thinned out [m]."""
    step = max(1, round(_OUTLINE_STEP / max(np.hypot(*np.diff(left[:2], axis=0)[0]), 0.1)))
    sides = (np.concatenate([side[:-1:step], side[-1:]]) for side in (left, right[::-1]))
    return _rounded(np.concatenate(list(sides)), 2)


def _lights(episode: Episode, town: Town) -> list[dict[str, Any]]:
    """Of each light its stop line, and what it shows from which step on."""
    lights = []
    for light in town.lights.values():
        shown = [int(signals.at(light, float(now) + episode.light_phase)) for now in episode.time]
        changes = [0, *(np.flatnonzero(np.diff(shown)) + 1).tolist()]
        lights.append(
            {
                "line": _rounded(light.stop_line, 2),
                "shows": [[step, shown[step]] for step in changes],
            }
        )
    return lights


def _rounded(values: np.ndarray, digits: int) -> list[Any]:
    return np.round(values, digits).tolist()
