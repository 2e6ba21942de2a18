"""Rows of houses along the streets, from a seed."""

from collections.abc import Iterator

import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.geometry import stations
from mjdrive.town.scenery.blocks import Block, block_behind, rings
from mjdrive.town.scenery.neighbourhood import Neighbourhood
from mjdrive.town.settings import SceneryConfig

STRAIGHTENING = 0.1  # of the building line [m]
LARGEST_BEND = 0.6  # between a front and a bent building line [m]
SHORTENING = 0.8  # a front that bends too much is tried again at this share of its length [-]
SMALLEST_CELL = 10.0  # of the squares in which houses look for each other [m]
STEP = 2.0  # to the next try where no front fits [m]


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
    built = Neighbourhood[shapely.Polygon](cell=max(scenery.building_width[1], SMALLEST_CELL))
    for ring in rings(shapely.simplify(building_line, STRAIGHTENING)):
        for house in _row(ring, scenery, rng):
            footprint = house.footprint()
            beside = built.near(footprint.bounds)
            if not keep_clear.intersects(footprint) and not np.any(
                shapely.intersects(beside, footprint)
            ):
                houses.append(house)
                built.add(footprint, footprint.bounds)
    return tuple(houses)


def _row(
    line: Float[np.ndarray, "N 2"], scenery: SceneryConfig, rng: np.random.Generator
) -> Iterator[Block]:
    """Houses side by side behind a building line, wherever it is about as straight as a front."""
    station = stations(line)
    at = rng.uniform(*scenery.building_gap)
    while at + scenery.building_width[0] <= station[-1]:
        width = rng.uniform(*scenery.building_width)
        depth = rng.uniform(*scenery.building_depth)
        height = rng.uniform(*scenery.building_height)
        front = _straight_front(line, station, at, width, scenery.building_width[0])
        if front is None:
            at += STEP
        else:
            yield block_behind(front[0], front[1], depth=depth, height=height)
            at += float(np.hypot(*(front[1] - front[0]))) + rng.uniform(*scenery.building_gap)


def _straight_front(
    line: Float[np.ndarray, "N 2"],
    station: Float[np.ndarray, " N"],
    start: float,
    width: float,
    shortest: float,
) -> Float[np.ndarray, "2 2"] | None:
    """Cut a front out of a building line, shortened until it leaves the line by no more than is seen."""
    while width >= shortest:
        inner = station[(station > start) & (station < start + width)]
        along = np.concatenate([[start], inner, [start + width]])
        if along[-1] > station[-1]:
            return None
        points = np.stack([np.interp(along, station, line[:, axis]) for axis in (0, 1)], axis=1)
        forward = (points[-1] - points[0]) / np.hypot(*(points[-1] - points[0]))
        offsets = (points - points[0]) @ np.array([-forward[1], forward[0]])
        if np.abs(offsets).max() <= LARGEST_BEND:
            return points[[0, -1]]
        width *= SHORTENING
    return None
