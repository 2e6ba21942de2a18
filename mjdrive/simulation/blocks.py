"""Upright boxes on the ground: what kerbs, sidewalks and buildings are made of."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.vehicle.assembly import OBSTACLE_BITS

DECIMALS = 3  # millimetres keep scene.xml short and free of rounding noise
SHOWN_GROUP = 1  # geoms for the eye only; group 0 collides and is seen, group 3 collides unseen


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

    def footprint(self) -> shapely.Polygon:
        """Ground that the box covers, world frame [m]."""
        along = 0.5 * self.length * np.array([np.cos(self.yaw), np.sin(self.yaw)])
        across = 0.5 * self.depth * np.array([-np.sin(self.yaw), np.cos(self.yaw)])
        corners = np.array([along + across, across - along, -along - across, along - across])
        return shapely.Polygon(np.array([self.x, self.y]) + corners)


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
        The box.
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


def add_block(spec: mujoco.MjSpec, name: str, block: Block, *, rgba: Sequence[float]) -> None:
    """Stand a box that the car can hit.

    Args:
        spec: Scene to add to.
        name: Of the geom.
        block: Where it stands and how large it is.
        rgba: Colour [-].
    """
    contype, conaffinity = OBSTACLE_BITS
    half = 0.5 * np.array([block.length, block.depth, block.height])
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=half.round(DECIMALS),
        pos=[round(block.x, DECIMALS), round(block.y, DECIMALS), round(half[2], DECIMALS)],
        quat=upright(block.yaw),
        contype=contype,
        conaffinity=conaffinity,
        rgba=rgba,
    )


def upright(yaw: float) -> list[float]:
    """Quaternion of a turn about the vertical [-], to six digits."""
    return [round(float(np.cos(0.5 * yaw)), 6), 0.0, 0.0, round(float(np.sin(0.5 * yaw)), 6)]


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
