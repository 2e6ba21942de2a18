"""Boxes and posts that the car can hit."""

import mujoco
import numpy as np

from mjdrive.town.scenery.blocks import Block
from mjdrive.vehicle.assembly import OBSTACLE_BITS

DECIMALS = 3  # millimetres keep scene.xml short and free of rounding noise
SHOWN_GROUP = 1  # geoms for the eye only; group 0 collides and is seen
UNSEEN_GROUP = 3  # collides unseen


def add_block(
    spec: mujoco.MjSpec, name: str, block: Block, *, material: str, group: int = 0
) -> None:
    """Stand a box that the car can hit.

    Args:
        spec: Scene to add to.
        name: Of the geom.
        block: Where it stands and how large it is.
        material: Of the scene.
        group: 0 to show it, `UNSEEN_GROUP` if a mesh shows it.
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
        group=group,
        material=material,
    )


def add_post(
    spec: mujoco.MjSpec,
    name: str,
    *,
    x: float,
    y: float,
    radius: float,
    height: float,
    material: str,
) -> None:
    """Stand a round post that the car can hit.

    Args:
        spec: Scene to add to.
        name: Of the geom.
        x: Middle, world frame [m].
        y: Middle, world frame [m].
        radius: Of the post [m].
        height: Of the post [m].
        material: Of the scene.
    """
    contype, conaffinity = OBSTACLE_BITS
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[round(radius, DECIMALS), round(0.5 * height, DECIMALS), 0],
        pos=[round(x, DECIMALS), round(y, DECIMALS), round(0.5 * height, DECIMALS)],
        contype=contype,
        conaffinity=conaffinity,
        material=material,
    )


def upright(yaw: float) -> list[float]:
    """Quaternion of a turn about the vertical [-], to six digits."""
    return [round(float(np.cos(0.5 * yaw)), 6), 0.0, 0.0, round(float(np.sin(0.5 * yaw)), 6)]
