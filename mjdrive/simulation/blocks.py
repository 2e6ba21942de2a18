"""Boxes of a layout as geoms that the car can hit."""

from collections.abc import Sequence

import mujoco
import numpy as np

from mjdrive.town.blocks import Block
from mjdrive.vehicle.assembly import OBSTACLE_BITS

DECIMALS = 3  # millimetres keep scene.xml short and free of rounding noise
SHOWN_GROUP = 1  # geoms for the eye only; group 0 collides and is seen, group 3 collides unseen


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
