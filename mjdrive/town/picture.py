"""Draw a town from above."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from shapely.plotting import plot_polygon

from mjdrive.datatypes import Move, Town
from mjdrive.town.surface import driving_surface

MOVE_COLOURS = {
    Move.FOLLOW: "#ffffff",
    Move.LEFT: "#4c9be8",
    Move.STRAIGHT: "#7bc67b",
    Move.RIGHT: "#f0a04b",
}
_ROAD = "#c4c8ce"

_LONGER_SIDE = 7.2  # of the map in a picture [inch]
_LABELS = 0.9  # room for scales [inch]


def draw(town: Town, axes: Axes) -> None:
    """Draw road, lanes, stop lines, poles and junction names.

    Args:
        town: The town.
        axes: Where to draw; world frame, equal scales [m].
    """
    plot_polygon(
        driving_surface(town), ax=axes, add_points=False, facecolor=_ROAD, edgecolor="none"
    )
    for lane in town.lanes.values():
        axes.plot(*lane.centerline.T, color=MOVE_COLOURS[lane.move], linewidth=0.7)
    for light in town.lights.values():
        axes.plot(*light.stop_line.T, color="#c0392b", linewidth=1.5)
        axes.plot(*light.pole, ".", color="#222222", markersize=3)
    for junction in sorted({light.junction for light in town.lights.values()}):
        points = [
            lane.centerline.mean(axis=0)
            for lane in town.lanes.values()
            if lane.junction == junction
        ]
        # Beside the crossing, where the name hides no lane.
        axes.annotate(
            junction,
            np.mean(points, axis=0),
            xytext=(13, 11),
            textcoords="offset points",
            fontsize=7,
            ha="center",
        )
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")


def save(town: Town, path: Path) -> None:
    """Write the picture of a town as PNG.

    Args:
        town: The town.
        path: File to write.
    """
    west, south, east, north = town.bounds
    width, height = east - west, north - south
    scale = _LONGER_SIDE / max(width, height)
    figure = Figure(
        figsize=(scale * width + _LABELS, scale * height + _LABELS), layout="constrained"
    )
    draw(town, figure.subplots())
    figure.savefig(path, dpi=110, metadata={"Software": None})
