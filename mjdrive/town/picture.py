"""Draw a town from above."""

import io
from pathlib import Path

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from mjdrive.config import require
from mjdrive.datatypes import Move, Town
from mjdrive.files import write_atomically
from mjdrive.town.surface import lane_polygons

MOVE_COLOURS = {
    Move.FOLLOW: "#ffffff",
    Move.LEFT: "#4c9be8",
    Move.STRAIGHT: "#7bc67b",
    Move.RIGHT: "#f0a04b",
}
_ROAD = "#c4c8ce"

_MARGIN = 12.0  # around the lanes [m]
_LONGER_SIDE = 7.2  # of the map in a picture [inch]
_LABELS = 0.9  # room for scales [inch]


def draw(town: Town, axes: Axes) -> None:
    """Draw road, lanes, stop lines, poles and junction names.

    Args:
        town: The town.
        axes: Where to draw; world frame, equal scales [m].
    """
    lanes, lights = town.lanes.values(), town.lights.values()
    outlines = [shapely.get_coordinates(polygon) for polygon in lane_polygons(town).values()]
    # The outline closes the hairline gaps between neighbouring lanes.
    axes.add_collection(PolyCollection(outlines, facecolor=_ROAD, edgecolor=_ROAD, linewidth=0.5))
    colours = [MOVE_COLOURS[lane.move] for lane in lanes]
    axes.add_collection(
        LineCollection([lane.centerline for lane in lanes], colors=colours, linewidth=0.7)
    )
    axes.add_collection(
        LineCollection([light.stop_line for light in lights], colors="#c0392b", linewidth=1.5)
    )
    if lights:
        poles = np.array([light.pole for light in lights])
        axes.plot(*poles.T, ".", color="#222222", markersize=3)
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
            parse_math=False,
            ha="center",
        )
    west, south, east, north = town.bounds
    axes.set(
        aspect="equal",
        xlim=(west - _MARGIN, east + _MARGIN),
        ylim=(south - _MARGIN, north + _MARGIN),
    )
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")


def save(town: Town, path: Path) -> None:
    """Write the picture of a town as PNG.

    Args:
        town: The town.
        path: PNG file to write.

    Raises:
        ConfigError: If the file is to end in something else.
    """
    require(
        path.suffix.lower() == ".png",
        f"Cannot draw a town into '{path}'; expected a file that ends in .png.",
    )
    west, south, east, north = town.bounds
    width, height = east - west, north - south
    scale = _LONGER_SIDE / max(width, height)
    figure = Figure(
        figsize=(scale * width + _LABELS, scale * height + _LABELS), layout="constrained"
    )
    draw(town, figure.subplots())
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=110, metadata={"Software": None})
    write_atomically(path, picture.getvalue())
