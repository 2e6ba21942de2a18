"""Where long drives led, side by side over the map of the town (the paper's figure, for any arms)."""

import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from mjdrive.datatypes import InfractionKind, Town
from mjdrive.evaluation.figure_style import SYMBOLS
from mjdrive.evaluation.figures import draw_town
from mjdrive.picture_style import STYLE, save
from mjdrive.study.pictures.figure_looks import Look
from mjdrive.study.records.results import DrivenPath

LONGEST_STEP = 25.0
"""Two points that are farther apart are not on one path [m]: no car is so fast in half a second."""

PIECE = 30
"""Steps of a path that are drawn in one go [-]: nobody comes round a block in fifteen seconds."""

MARGIN = 5.0
"""Ground shown around the lanes [m]."""

PINS = {
    "red_lights": SYMBOLS[InfractionKind.RED_LIGHT],
    "mishaps": ("hit something or left the road", *SYMBOLS[InfractionKind.COLLISION][1:]),
}
"""Legend text, marker and colour of what is pinned to the map, by the field that lists the places."""


SIZES = {"*": 110.0}
"""Of markers that fill less of their square than others [pt^2]."""


def draw_paths(
    paths: Sequence[tuple[Look, DrivenPath]], town: Town, path: Path, *, columns: int = 2
) -> None:
    """Draw one map a drive: the more often a street was driven, the darker its line; infractions are pinned.

    Args:
        paths: Each drive with its look, at least one.
        town: Where they were driven.
        path: PNG file to write.
        columns: Maps beside each other [-].
    """
    with matplotlib.style.context(["default", STYLE]):
        width, height = (float(side) + 2 * MARGIN for side in town.bounds[2:] - town.bounds[:2])
        columns = min(columns, len(paths))
        rows = math.ceil(len(paths) / columns)
        wide = 9.0 / columns
        size = (9.0, rows * (wide * height / width + 0.5) + 0.35)
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.flat:
            axes.set_axis_off()
        for axes, (look, driven) in zip(grid.flat, paths, strict=False):
            draw_town(axes, town)
            _draw_path(axes, driven, colour=look.colour)
            _draw_pins(axes, driven)
            axes.set(
                xlim=(town.bounds[0] - MARGIN, town.bounds[2] + MARGIN),
                ylim=(town.bounds[1] - MARGIN, town.bounds[3] + MARGIN),
            )
            axes.set_title(_title(look, driven), fontsize=9 if columns < 3 else 8)
        handles = {
            text: handle
            for axes in grid.flat
            for handle, text in zip(*axes.get_legend_handles_labels(), strict=True)
        }
        if handles:
            labels = list(handles)
            figure.legend(
                handles.values(), labels, loc="outside lower center", ncols=3, frameon=False
            )
        save(figure, path)


def _title(look: Look, driven: DrivenPath) -> str:
    lengths = np.hypot(*np.diff(np.array(driven.points), axis=0).T)
    kilometres = float(lengths.sum()) / 1000
    return (
        f"{look.label}\n{kilometres:.1f} km in {driven.duration_s:,.0f} s, "
        f"{len(driven.red_lights)} red, {len(driven.mishaps)} mishap{'' if len(driven.mishaps) == 1 else 's'}"
    )


def _draw_path(axes: Axes, driven: DrivenPath, *, colour: str) -> None:
    """Draw a path in short pieces, so that one street driven again is darker than before."""
    points = np.array(driven.points)
    jumps = np.hypot(*np.diff(points, axis=0).T) > LONGEST_STEP
    ends = np.flatnonzero(jumps) + 1
    pieces = [
        part[first : first + PIECE + 1]
        for part in np.split(points, ends)
        for first in range(0, len(part) - 1, PIECE)
    ]
    opacity = min(0.15 * math.sqrt(3000.0 / max(driven.duration_s, 1.0)), 0.6)
    axes.add_collection(
        LineCollection(
            pieces, color=colour, linewidth=1.8, alpha=opacity, capstyle="butt", zorder=2
        )
    )
    axes.plot(*points[0], "o", color="white", mec="black", ms=5, zorder=3, label="start", ls="")


def _draw_pins(axes: Axes, driven: DrivenPath) -> None:
    for name, (label, marker, colour) in PINS.items():
        places = np.array(getattr(driven, name)).reshape(-1, 2)
        if len(places):
            axes.scatter(
                places[:, 0],
                places[:, 1], s=SIZES.get(marker, 50.0), marker=marker, color=colour, edgecolor="white", linewidth=0.6,
                label=label, zorder=4,
            )  # fmt: skip
