"""Rows of houses along the streets, from a seed."""

from itertools import pairwise

import numpy as np
import shapely

from mjdrive.simulation.blocks import Block, block_behind, rings
from mjdrive.town.settings import SceneryConfig

STRAIGHTENING = 0.3  # outline of the building line [m]


def buildings(road: shapely.Geometry, scenery: SceneryConfig) -> list[Block]:
    """Line the streets with houses of varied size.

    Args:
        road: Surface between the kerbs [m].
        scenery: Sizes, gaps, setback and seed.

    Returns:
        Houses that touch neither road, sidewalk nor each other.
    """
    rng = np.random.default_rng(scenery.seed)
    sidewalk = shapely.buffer(road, scenery.sidewalk_width)
    building_line = shapely.buffer(sidewalk, scenery.building_setback)
    keep_clear = shapely.buffer(sidewalk, 0.5 * scenery.building_setback)
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
    return houses


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
