"""Rows of houses along the streets, from a seed."""

from itertools import pairwise

import numpy as np
import shapely

from mjdrive.town.blocks import Block, block_behind, rings
from mjdrive.town.settings import SceneryConfig

STRAIGHTENING = 0.3  # outline of the building line [m]


def line_with_houses(
    streets: shapely.Geometry,
    scenery: SceneryConfig,
    rng: np.random.Generator,
    *,
    taken: shapely.Geometry | None = None,
) -> tuple[Block, ...]:
    """Line the streets with houses of varied size; where there is no room there are fewer.

    Args:
        streets: Roads and all that belongs to them, sidewalks and verges [m].
        scenery: Sizes, gaps and setback.
        rng: Draws sizes and gaps.
        taken: Ground where other things stand already [m].

    Returns:
        Houses that touch neither the streets nor taken ground nor each other; each looks to the left of its yaw, at its street.
    """
    building_line = shapely.buffer(streets, scenery.building_setback)
    keep_clear = shapely.buffer(streets, 0.5 * scenery.building_setback)
    if taken is not None:
        keep_clear = keep_clear | taken
    shapely.prepare(keep_clear)
    houses: list[Block] = []
    footprints: list[shapely.Polygon] = []
    for ring in rings(shapely.simplify(building_line, STRAIGHTENING)):
        for start, end in pairwise(ring):
            for house in _row(start, end, scenery, rng):
                footprint = house.footprint()
                if not keep_clear.intersects(footprint) and not np.any(
                    shapely.intersects(footprints, footprint)
                ):
                    houses.append(house)
                    footprints.append(footprint)
    return tuple(houses)


def _row(
    start: np.ndarray, end: np.ndarray, scenery: SceneryConfig, rng: np.random.Generator
) -> list[Block]:
    """Houses side by side behind one straight stretch of the building line."""
    length = float(np.hypot(*(end - start)))
    forward = (end - start) / length
    houses = []
    station = rng.uniform(*scenery.building_gap)
    while station + scenery.building_width[0] <= length:
        width = min(rng.uniform(*scenery.building_width), length - station)
        front = start + station * forward, start + (station + width) * forward
        depth = rng.uniform(*scenery.building_depth)
        height = rng.uniform(*scenery.building_height)
        houses.append(block_behind(*front, depth=depth, height=height))
        station += width + rng.uniform(*scenery.building_gap)
    return houses
