"""Upright boxes on the ground: the shape of kerbs, sidewalks and houses."""

from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float


@dataclass(frozen=True, slots=True)
class Block:
    """A box that stands on the ground.

    Attributes:
        x: Centre, world frame [m].
        y: Centre, world frame [m].
        yaw: Direction of its length [rad].
        length: Along yaw [m].
        depth: Across yaw [m].
        height: Above the ground [m].
    """

    x: float
    y: float
    yaw: float
    length: float
    depth: float
    height: float

    def corners(self) -> Float[np.ndarray, "4 2"]:
        """Corners of its ground plan, counter-clockwise from the far right one, world frame [m]."""
        along = 0.5 * self.length * np.array([np.cos(self.yaw), np.sin(self.yaw)])
        across = 0.5 * self.depth * np.array([-np.sin(self.yaw), np.cos(self.yaw)])
        centre = np.array([self.x, self.y])
        return centre + np.array([along - across, along + across, across - along, -along - across])

    def footprint(self) -> shapely.Polygon:
        """Ground that the box covers, world frame [m]."""
        return shapely.Polygon(self.corners())


def block_behind(
    start: Float[np.ndarray, "2"], end: Float[np.ndarray, "2"], *, depth: float, height: float
) -> Block:
    """Stand a box to the right of a line, its front face on the line.

    Args:
        start: One end of the front, world frame [m].
        end: Other end of the front, world frame [m].
        depth: How far it reaches behind the line [m].
        height: Above the ground [m].

    Returns:
        The box; its front looks to the left of its yaw.
    """
    length = float(np.hypot(*(end - start)))
    forward = (end - start) / length
    right = np.array([forward[1], -forward[0]])
    centre = 0.5 * (start + end) + 0.5 * depth * right
    return Block(
        x=float(centre[0]),
        y=float(centre[1]),
        yaw=float(np.arctan2(forward[1], forward[0])),
        length=length,
        depth=depth,
        height=height,
    )


def rings(area: shapely.Geometry) -> list[Float[np.ndarray, "N 2"]]:
    """List the closed outlines of an area, each with the area on its left.

    Args:
        area: Polygon or several [m].

    Returns:
        Outlines whose last point repeats the first [m].
    """
    polygons = [shapely.orient_polygons(part) for part in shapely.get_parts(area)]
    return [
        shapely.get_coordinates(ring)
        for polygon in polygons
        for ring in (polygon.exterior, *polygon.interiors)
    ]
