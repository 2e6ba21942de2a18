"""Snapshot forking in pictures: fifty drives from one moment before a junction, over the map, coloured by exit."""

import math
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from mjdrive.datatypes import Town
from mjdrive.evaluation.figures import draw_town
from mjdrive.picture_style import STYLE, save
from mjdrive.study.pictures.figures_choices import MOVES
from mjdrive.study.records.fans import FanRecord

LOST = ("#57606a", "no exit driven to its end")
UNSAFE = ("#d1242f", "left the road or hit something")
"""Colours and legend texts of drives that took no exit."""

MARGIN = 9.0
"""Ground shown around the junction lanes and the paths through them [m]."""

ACROSS, COLUMN = 4, 2.3
"""Panels beside each other [-], and width of each [inch]."""

_LEGEND_COLUMNS = {1: 1, 2: 2}
"""Of the five entries, by the number of panels beside each other, so that none is cut off [-]."""


def draw_fans(fans: Sequence[tuple[str, FanRecord]], town: Town, path: Path) -> None:
    """Draw one panel a policy and moment.

    Args:
        fans: Label and what was driven, at least one.
        town: Where.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        columns = min(ACROSS, len(fans))
        rows = math.ceil(len(fans) / columns)
        legend_columns = _LEGEND_COLUMNS.get(columns, 5)
        size = (
            COLUMN * columns + (0.2 if columns > 1 else 0.9),
            2.75 * rows + 0.5 + 0.16 * math.ceil(5 / legend_columns),
        )
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.flat:
            axes.set_axis_off()
        for axes, (label, fan) in zip(grid.flat, fans, strict=False):
            draw_fan(axes, fan, town)
            axes.set_title(f"{label}\n{_counts(fan, town)}", fontsize=8)
        handles = [
            Line2D([], [], color=colour, lw=2, label=f"went {move}" if move == "straight" else f"turned {move}")
            for move, colour in MOVES.items()
        ]  # fmt: skip
        handles += [
            Line2D([], [], color=colour, lw=2, label=text) for colour, text in (LOST, UNSAFE)
        ]
        figure.legend(
            handles=handles, loc="outside lower center", ncols=legend_columns,
            frameon=False, fontsize=8,
        )  # fmt: skip
        save(figure, path)


def draw_fan(axes: Axes, fan: FanRecord, town: Town) -> None:
    """Draw every path from one moment over the map around it.

    Args:
        axes: Where; its limits are set.
        fan: What was driven.
        town: Where it was driven.
    """
    draw_town(axes, town)
    for one in fan.paths:
        axes.add_collection(
            LineCollection(
                [np.array(one.points)],
                color=_colour(one.exit, one.is_safe, town),
                lw=1.3,
                alpha=0.55,
            )
        )
    start = np.array(fan.paths[0].points[0])
    axes.plot(*start, "o", color="white", mec="black", ms=5, zorder=3)
    lanes = np.concatenate([town.lanes[name].centerline for name in fan.exits] + [start[None]])
    middle = (lanes.min(axis=0) + lanes.max(axis=0)) / 2
    half = float((lanes.max(axis=0) - lanes.min(axis=0)).max()) / 2 + MARGIN
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))


def _colour(exit_name: str, is_safe: bool, town: Town) -> str:
    if not is_safe:
        return UNSAFE[0]
    return MOVES[_move(exit_name, town)] if exit_name else LOST[0]


def _counts(fan: FanRecord, town: Town) -> str:
    """How many safe drives went which way, in words."""
    ways = Counter(_move(it.exit, town) for it in fan.paths if it.is_safe and it.exit)
    rest = len(fan.paths) - ways.total()
    words = [f"{ways[_move(name, town)]} {_move(name, town)}" for name in fan.exits]
    return ", ".join(words + ([f"{rest} neither"] if rest else []))


def _move(lane: str, town: Town) -> str:
    return town.lanes[lane].move.name.lower()
