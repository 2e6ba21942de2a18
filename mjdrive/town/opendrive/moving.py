"""Move a map, so that the numbers of a survey become small."""

from dataclasses import replace

import numpy as np

from mjdrive.town.opendrive.road_map import Road, RoadMap

FAR = 10_000.0
"""Farther than this from the origin, single-precision pictures are off by more than a millimetre [m]."""

_STEP = 100.0
"""New origins are multiples of this [m]."""


def near_origin(road_map: RoadMap) -> tuple[float, float]:
    """Choose the point of a map that becomes the origin of its town.

    Args:
        road_map: The map.

    Returns:
        (0, 0) where all of it lies near its own origin; else a round point in its middle, x and y [m].
    """
    starts = np.array(
        [(piece.x, piece.y) for road in road_map.roads.values() for piece in road.pieces]
    )
    if np.abs(starts).max() <= FAR:
        return 0.0, 0.0
    middle = 0.5 * (starts.min(axis=0) + starts.max(axis=0))
    x, y = (_STEP * np.round(middle / _STEP)).tolist()
    return x, y


def moved(road_map: RoadMap, origin: tuple[float, float]) -> RoadMap:
    """Move a map so that a point of it becomes the origin.

    Args:
        road_map: The map.
        origin: That point, x and y [m].

    Returns:
        The same roads and objects, elsewhere; the map itself if the point is its origin.
    """
    if origin == (0.0, 0.0):
        return road_map
    roads = {road.id: _moved_road(road, *origin) for road in road_map.roads.values()}
    return replace(road_map, roads=roads)


def _moved_road(road: Road, x: float, y: float) -> Road:
    pieces = tuple(replace(piece, x=piece.x - x, y=piece.y - y) for piece in road.pieces)
    objects = tuple(
        replace(thing, outline=tuple((px - x, py - y) for px, py in thing.outline))
        for thing in road.objects
    )
    return replace(road, pieces=pieces, objects=objects)
