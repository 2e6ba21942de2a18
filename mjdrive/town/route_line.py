"""From a chain of lanes to a dense route."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Route, Town
from mjdrive.errors import RouteError
from mjdrive.geometry import curvatures, headings, resample, stations

POINT_SPACING = 1.0
"""Distance between the points of a route [m]."""


class Chain(NamedTuple):
    """The lanes of a route.

    Attributes:
        lanes: Names, each a successor of the one before.
        start: Where the route begins on the first lane [m].
        end: Where it ends on the last lane [m].
    """

    lanes: tuple[str, ...]
    start: float
    end: float


def lay(town: Town, chain: Sequence[str], *, start: float, end: float) -> Route:
    """Lay points along a chain of lanes, from a station on the first to a station on the last.

    Args:
        town: The town.
        chain: Names of lanes, each a successor of the one before.
        start: Where the route begins on the first lane [m].
        end: Where it ends on the last lane [m].

    Returns:
        The route.

    Raises:
        RouteError: If it is shorter than the distance of two points.
    """
    lines = [town.lanes[name].centerline for name in chain]
    ends = np.cumsum([stations(line)[-1] for line in lines])
    for first, second in pairwise(chain):
        assert second in town.lanes[first].successors, f"{second} does not follow {first}"
    line = np.concatenate([lines[0], *(line[1:] for line in lines[1:])])
    station = stations(line)
    stop = (ends[-2] if len(ends) > 1 else 0.0) + end
    if stop - start < POINT_SPACING:
        raise RouteError(
            f"The route is {stop - start:.2f} m long; expected at least {POINT_SPACING} m."
        )
    inside = (station > start + 1e-9) & (station < stop - 1e-9)
    cut = np.concatenate([[start], station[inside], [stop]])
    trimmed = np.stack([np.interp(cut, station, line[:, axis]) for axis in (0, 1)], axis=1)
    points = resample(trimmed, POINT_SPACING)
    along = np.minimum(POINT_SPACING * np.arange(len(points)), stop - start)
    return Route(
        lanes=tuple(chain),
        points=points,
        station=along,
        yaw=headings(points),
        curvature=curvatures(points),
        lane_index=np.searchsorted(ends[:-1], along + start + 1e-9, side="right"),
    )
