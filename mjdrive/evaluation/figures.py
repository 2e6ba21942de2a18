"""Maps of drives and data sets: PNG, the same bytes for the same drive, drawn without a display."""

import math
from collections.abc import Mapping
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation import metrics
from mjdrive.evaluation.figure_style import SYMBOLS, title
from mjdrive.picture_style import STYLE, save
from mjdrive.town.surface import lane_polygons

SYMBOL_SPACING, SMALL_SPACING = 0.022, 0.04
"""Least distance between symbols on a map and on a small map, over the larger side of the map [-]."""

MARGIN = 12.0
"""Ground shown around the lanes [m]."""

MOST_MAPS = 50
"""Episodes that one picture shows; nobody looks at more, and pictures have a greatest height [-]."""


def draw_trajectory(episode: Episode, town: Town, path: Path) -> None:
    """Draw the path of a drive over the map of the town, coloured by time, infractions marked.

    Args:
        episode: The drive.
        town: The town that it was driven in.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        width, height = map_extent(town)
        figure = Figure(figsize=(7.5, 6.2 * height / width + 0.9), layout="constrained")
        axes = figure.add_subplot()
        draw_town(axes, town)
        line = _draw_path(axes, episode, line_width=2.2)
        _draw_ends(axes, episode)
        _draw_infractions(axes, episode, town)
        axes.set(xlabel="x, east [m]", ylabel="y, north [m]", title=title(episode))
        figure.colorbar(line, ax=axes, label="time [s]", shrink=0.7, pad=0.02)
        if len(episode.time):
            figure.legend(loc="outside lower center", ncols=4, frameon=False)
        save(figure, path)


def draw_dataset(episodes: Mapping[str, Episode], town: Town, path: Path) -> None:
    """Draw the episodes of a data set over the map of its town, one small map each.

    Args:
        episodes: The drives by name, at least one; of more than `MOST_MAPS`, the first are drawn.
        town: The town that they were driven in.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        width, height = map_extent(town)
        drawn = list(episodes.items())[:MOST_MAPS]
        num_columns = min(len(drawn), 5)
        num_rows = math.ceil(len(drawn) / num_columns)
        figure = Figure(
            figsize=(2.6 * num_columns, (2.6 * height / width + 0.3) * num_rows),
            layout="constrained",
        )
        grid = figure.subplots(num_rows, num_columns, squeeze=False)
        for axes in grid.flat:
            axes.set_axis_off()
        for axes, (name, episode) in zip(grid.flat, drawn, strict=False):
            draw_town(axes, town)
            _draw_path(axes, episode, line_width=1.4)
            _draw_ends(axes, episode)
            _draw_infractions(axes, episode, town, size=25.0, spacing=SMALL_SPACING)
            axes.set_title(f"{name}: {metrics.distance_on_lanes(episode):,.0f} m", fontsize=8)
        save(figure, path)


def map_extent(town: Town) -> tuple[float, float]:
    """Width and height of the ground that a map of a town shows [m]."""
    return (
        float(town.bounds[2] - town.bounds[0]) + 2 * MARGIN,
        float(town.bounds[3] - town.bounds[1]) + 2 * MARGIN,
    )


def draw_town(axes: Axes, town: Town) -> None:
    """Draw lanes and stop lines on equal axes."""
    lanes = [np.asarray(polygon.exterior.coords) for polygon in lane_polygons(town).values()]
    # The outline closes the hairline gaps between neighbouring lanes.
    axes.add_collection(
        PolyCollection(lanes, facecolor="#dcdfe3", edgecolor="#dcdfe3", linewidth=0.8)
    )
    stop_lines = [light.stop_line for light in town.lights.values()]
    axes.add_collection(LineCollection(stop_lines, color="#6e7781", linewidth=1.2))
    smallest_x, smallest_y, largest_x, largest_y = town.bounds
    axes.set(
        aspect="equal",
        xlim=(smallest_x - MARGIN, largest_x + MARGIN),
        ylim=(smallest_y - MARGIN, largest_y + MARGIN),
    )
    step = 100.0 if largest_x - smallest_x > 300 else 50.0
    axes.xaxis.set_major_locator(MultipleLocator(step))
    axes.yaxis.set_major_locator(MultipleLocator(step))


def _draw_path(axes: Axes, episode: Episode, *, line_width: float) -> LineCollection:
    """Draw the path of the rear axle, coloured by time."""
    points = episode.vehicle[:, :2]
    line = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)),
        array=episode.time[:-1],
        cmap="viridis",
        linewidth=line_width,
        capstyle="round",
        zorder=2,
    )
    line.set_clim(0.0, max(float(episode.time[-1]), 1.0) if len(episode.time) else 1.0)
    axes.add_collection(line)
    return line


def _draw_ends(axes: Axes, episode: Episode) -> None:
    """Mark where the drive began, which way the car looked, and where it ended."""
    if not len(episode.time):
        return
    x, y, yaw = episode.vehicle[0, :3]
    axes.plot(x, y, "o", color="white", mec="black", linestyle="", label="start", zorder=3)
    axes.plot(x, y, marker=(3, 0, math.degrees(yaw) - 90.0), color="black", ms=4, zorder=3)
    x, y = episode.vehicle[-1, :2]
    axes.plot(x, y, "s", color="black", markersize=4, linestyle="", label="end", zorder=3)


def _draw_infractions(
    axes: Axes, episode: Episode, town: Town, *, size: float = 90.0, spacing: float = SYMBOL_SPACING
) -> None:
    """Mark each infraction with the symbol of its kind; the legend counts them."""
    gap = spacing * max(map_extent(town))
    drawn: list[tuple[float, float]] = []
    for kind, (label, marker, color) in SYMBOLS.items():
        places = [(it.x, it.y) for it in episode.infractions if it.kind == kind]
        if places:
            free = [_moved_off(place, drawn, gap) for place in places]
            drawn += free
            x, y = np.array(free).T
            text = f"{label} ({len(places)})"
            area = 1.8 * size if marker == "*" else size  # a star fills little of its box
            axes.scatter(
                x, y, s=area, marker=marker, color=color, edgecolor="white", label=text, zorder=4
            )


def _moved_off(
    place: tuple[float, float], taken: list[tuple[float, float]], gap: float
) -> tuple[float, float]:
    """Move a symbol north until it hides none of those that are drawn."""
    while any(math.dist(place, other) < 0.99 * gap for other in taken):
        place = (place[0], place[1] + gap)
    return place
