"""Routes along the lanes of a town."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Route, Town
from mjdrive.errors import RouteError
from mjdrive.geometry import Projection, project, wrap_angle
from mjdrive.town.lane_graph import LaneGraph, Place, lane_length, onward
from mjdrive.town.random_lanes import random_lanes
from mjdrive.town.route_line import Chain, lay

_METRES_PER_RADIAN = 1.0
"""How far a lane may lie further off when its heading fits better by one radian [m/rad]."""

_ROUNDING = 1e-6
"""Lengths that are added up in another order may differ by this [m]."""

_CLEAR_BEFORE_JUNCTION = 15.0
"""Least distance from a random start to the end of its lane [m]."""


def nearest_lane(
    town: Town, point: Float[np.ndarray, "2"], *, yaw: float | None = None
) -> tuple[str, Projection]:
    """Find the lane that a point lies on, or the one closest to it.

    Args:
        town: The town.
        point: Position in the world frame [m].
        yaw: Heading that tells overlapping lanes and directions apart [rad]; distance alone decides if None.

    Returns:
        Name of the lane, and the point projected onto its centre line.
    """
    points, starts = _vertices(town)
    reach = np.sqrt(np.minimum.reduceat(np.sum((points - point) ** 2, axis=1), starts))
    # Points of a centre line are at most half a metre apart, so no other lane can be nearer; with a heading,
    # lanes that lie further off compete too.
    margin = 0.5 + (0.0 if yaw is None else np.pi * _METRES_PER_RADIAN)
    names = list(town.lanes)
    near = [names[index] for index in np.flatnonzero(reach <= reach.min() + margin)]
    best: tuple[float, str, Projection] | None = None
    for name in near:
        projection = project(town.lanes[name].centerline, point)
        cost = abs(projection.offset)
        if yaw is not None:
            along = np.diff(
                town.lanes[name].centerline[projection.segment : projection.segment + 2], axis=0
            )[0]
            cost += _METRES_PER_RADIAN * abs(
                wrap_angle(yaw - float(np.arctan2(along[1], along[0])))
            )
        if best is None or cost < best[0]:
            best = (cost, name, projection)
    assert best is not None
    return best[1], best[2]


@lru_cache(maxsize=4)
def _vertices(town: Town) -> tuple[Float[np.ndarray, "N 2"], np.ndarray]:
    """Stack the centre lines of all lanes [m]; the second array tells where each lane begins."""
    lines = [lane.centerline for lane in town.lanes.values()]
    return np.concatenate(lines), np.cumsum([0, *(len(line) for line in lines[:-1])])


@lru_cache(maxsize=4)
def _boxes(
    town: Town,
) -> tuple[tuple[str, ...], Float[np.ndarray, "N 2"], Float[np.ndarray, "N 2"]]:
    """Name the lanes, and the south-west and north-east corners of boxes that hold them [m]."""
    points, starts = _vertices(town)
    reach = np.array([[lane.width] for lane in town.lanes.values()])
    low, high = (extreme.reduceat(points, starts, axis=0) for extreme in (np.minimum, np.maximum))
    return tuple(town.lanes), low - reach, high + reach


def route_through(town: Town, waypoints: Float[np.ndarray, "K 2"]) -> Route:
    """Lay the shortest route through waypoints in their order, along the direction of the lanes.

    Args:
        town: The town.
        waypoints: Places on lanes in the world frame [m]; where lanes overlap, all that a place lies on count.

    Returns:
        Route from the first to the last waypoint.

    Raises:
        RouteError: If a waypoint lies on no lane or cannot be reached from the one before.
    """
    if len(waypoints) < 2:
        raise RouteError(f"A route has {len(waypoints)} waypoints; expected two or more.")
    places = [_places(town, index, waypoint) for index, waypoint in enumerate(waypoints)]
    graph = LaneGraph(town)
    # Dynamic programming: the best way to a place of a waypoint extends the best way to some place before it.
    ways = [_Way(off, place, place, (place.lane,)) for place, off in places[0]]
    for index, current in enumerate(places[1:], start=1):
        ways = [
            way for place, off in current if (way := _best_way(graph, ways, place, off)) is not None
        ]
        if not ways:
            raise RouteError(
                f"Waypoint {index} {_text(waypoints[index])} cannot be reached from waypoint {index - 1} "
                f"{_text(waypoints[index - 1])} along the lanes. Check the side of the road that it lies on."
            )
    best = min(ways, key=lambda way: way.cost)
    return lay(town, best.lanes, start=best.start.station, end=best.end.station)


def random_route(
    town: Town, *, lane: str, station: float, length: float, rng: np.random.Generator
) -> Route:
    """Follow the lanes, choosing each way at a junction with the same probability.

    Ways that come to a dead end before the route is long enough are left out.

    Args:
        town: The town.
        lane: Name of the lane to start on.
        station: Where on it to start [m].
        length: Length of the route [m].
        rng: Source of the choices.

    Returns:
        Route of exactly that length.

    Raises:
        UnknownNameError: If there is no such lane.
        RouteError: If the station is not on the lane, or every way comes to a dead end too soon.
    """
    chain = random_chain(town, lane=lane, station=station, length=length, rng=rng)
    return lay(town, chain.lanes, start=chain.start, end=chain.end)


def random_chain(
    town: Town, *, lane: str, station: float, length: float, rng: np.random.Generator
) -> Chain:
    """Choose the lanes of a random route without laying it; see `random_route`."""
    names = random_lanes(town, lane=lane, station=station, length=length, rng=rng)
    lanes = [next(names)]
    left = length - (lane_length(town.lanes[lane]) - station)
    while left > _ROUNDING:
        lanes.append(next(names))
        left -= lane_length(town.lanes[lanes[-1]])
    return Chain(tuple(lanes), station, lane_length(town.lanes[lanes[-1]]) + left)


def random_start(town: Town, rng: np.random.Generator, *, length: float = 0.0) -> tuple[str, float]:
    """Draw a place to start, uniform over the lanes outside junctions, 15 m or more before their ends.

    Lanes from which every way comes to a dead end are left out, unless the town has no others. Then places from
    which some way is long enough are taken, where there are any.

    Args:
        town: The town.
        rng: Source of the draw.
        length: How far the way onward should be [m].

    Returns:
        Name of the lane and station on it [m].

    Raises:
        RouteError: If no lane is long enough.
    """
    names, room = _starts(town, length)
    if not names:
        raise RouteError(
            f"Town '{town.name}' has no lane outside junctions longer than {_CLEAR_BEFORE_JUNCTION} m."
        )
    ends = np.cumsum(room)
    draw = rng.uniform(0.0, ends[-1])
    index = int(np.searchsorted(ends, draw, side="right"))
    return names[index], float(draw - (ends[index] - room[index]))


@lru_cache(maxsize=4)
def _starts(town: Town, length: float) -> tuple[tuple[str, ...], Float[np.ndarray, " N"]]:
    """Lanes to start on, and how much of each from its start on will do [m]."""
    clear = {
        name: lane_length(lane) - _CLEAR_BEFORE_JUNCTION
        for name, lane in town.lanes.items()
        if lane.junction is None and lane_length(lane) > _CLEAR_BEFORE_JUNCTION
    }
    ahead = onward(town) if clear else {}
    endless = {name: room for name, room in clear.items() if np.isinf(ahead[name])}
    reach = {name: lane_length(town.lanes[name]) + ahead[name] - length for name in clear}
    enough = {
        name: min(room, reach[name] - _ROUNDING)
        for name, room in clear.items()
        if reach[name] > _ROUNDING
    }
    room = endless or enough or clear
    return tuple(room), np.array(list(room.values()))


class _Way(NamedTuple):
    """A way through the first waypoints: its cost [m], both ends, and the lanes."""

    cost: float
    start: Place
    end: Place
    lanes: tuple[str, ...]


def _best_way(graph: LaneGraph, ways: list[_Way], place: Place, off: float) -> _Way | None:
    """Extend the ways found so far to a place that is `off` metres from its waypoint; keep the cheapest."""
    extended = [
        _Way(way.cost + off + leg.length, way.start, place, way.lanes + leg.entered)
        for way in ways
        if (leg := graph.leg(way.end, place)) is not None
    ]
    return min(extended, key=lambda way: way.cost, default=None)


def _places(town: Town, index: int, waypoint: Float[np.ndarray, "2"]) -> list[tuple[Place, float]]:
    """Find the places on lanes that a waypoint lies on, and its distances from the centre lines [m]."""
    found = []
    names, low, high = _boxes(town)
    for number in np.flatnonzero(((low <= waypoint) & (waypoint <= high)).all(axis=1)):
        lane = town.lanes[names[number]]
        if ((lane.centerline - waypoint) ** 2).sum(axis=1).min() <= lane.width**2:
            projection = project(lane.centerline, waypoint)
            if abs(projection.offset) <= lane.width / 2:
                found.append((Place(lane.id, projection.station), abs(projection.offset)))
    if not found:
        name, projection = nearest_lane(town, waypoint)
        raise RouteError(
            f"Waypoint {index} {_text(waypoint)} lies on no lane; the nearest, '{name}', is "
            f"{abs(projection.offset):.2f} m away."
        )
    return found


def _text(point: Float[np.ndarray, "2"]) -> str:
    return f"({point[0]:.1f}, {point[1]:.1f})"
