"""The exercises on which settings are judged: bends of every shape that a town has, and a start beside the lane."""

import dataclasses
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Episode, Lane, Policy, Route, Signal, Situation, Town
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute
from mjdrive.errors import RouteError
from mjdrive.geometry import curvatures, headings
from mjdrive.simulation.simulation import Simulation
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.route_line import lay

APPROACH = 25.0
"""Way before and after each bend [m]: 10 m to reach 5 m/s, 15 m to settle."""

BESIDE = 0.7
"""How far beside its lane the car starts in the exercise of coming back [m]."""

STEPS_PER_METRE = 8.0
"""Control steps allowed per metre of an exercise [1/m]; a car that is slower is stuck."""


class Exercise(NamedTuple):
    """One short drive from standstill, with green lights.

    Attributes:
        name: The lane through the junction, or "beside" and the lane.
        route: What to follow.
        offset: Where the car starts, to the left of the route [m].
    """

    name: str
    route: Route
    offset: float


class Trace(NamedTuple):
    """What was seen of one exercise.

    Attributes:
        episode: The drive.
        offsets: Distance from the route at each step, positive to the left, shape (T,) [m].
        is_finished: Whether the car came to the end in time.
        length: Length of the route [m].
    """

    episode: Episode
    offsets: np.ndarray
    is_finished: bool
    length: float


def course(town: Town, *, bends: int) -> tuple[Exercise, ...]:
    """Choose exercises that differ: bends from the tightest to the widest, left and right, and a start beside the lane.

    Args:
        town: Where they are driven.
        bends: How many ways through junctions at most.

    Returns:
        The exercises, the tightest bend first, the start beside the lane last.

    Raises:
        RouteError: If the town has no way through a junction with a lane before and after it.
    """
    found = {_shape(way.lane): way for way in _ways(town)}
    ways = sorted(found.values(), key=lambda way: -_tightness(way.lane))
    if not ways:
        raise RouteError(
            f"Town '{town.name}' has no way through a junction with a lane before and after it. Expected one to tune "
            "on; name another town with --town."
        )
    chosen = [ways[i] for i in np.unique(np.linspace(0, len(ways) - 1, bends).round().astype(int))]
    exercises = [Exercise(way.lane.id, _route(town, way), 0.0) for way in chosen]
    # The widest of all, straight on where there is such a way.
    return (*exercises, Exercise(f"beside {ways[-1].lane.id}", _route(town, ways[-1]), BESIDE))


def drive(simulation: Simulation, exercise: Exercise, expert: Policy[Situation]) -> Trace:
    """Let an expert drive one exercise.

    Args:
        simulation: World to drive in; it is reset.
        exercise: What to drive.
        expert: Who drives.
    """
    route = exercise.route
    follow = FollowRoute(route)
    yaw = float(route.yaw[0])
    x, y = route.points[0] + exercise.offset * np.array([-np.sin(yaw), np.cos(yaw)])
    simulation.place(x=float(x), y=float(y), yaw=yaw, seed=0)
    offsets: list[float] = []

    def with_green_lights(simulation: Simulation) -> Situation:
        situation = follow(simulation)
        offsets.append(situation.offset)
        return dataclasses.replace(
            situation, lights=dict.fromkeys(simulation.town.lights, Signal.GREEN)
        )

    episode = rollout(
        simulation,
        expert,
        with_green_lights,
        num_steps=int(STEPS_PER_METRE * route.station[-1]),
        seed=0,
        stop=lambda: follow.is_finished,
    )
    return Trace(episode, np.array(offsets), follow.is_finished, float(route.station[-1]))


class _Way(NamedTuple):
    """A way through a junction, with a lane before and after it."""

    before: str
    lane: Lane
    after: str


def _ways(town: Town) -> Iterator[_Way]:
    for name, lane in town.lanes.items():
        for middle in lane.successors:
            way = town.lanes[middle]
            if lane.junction is None and way.junction is not None and way.successors:
                yield _Way(name, way, way.successors[0])


def _shape(lane: Lane) -> tuple[int, int]:
    """Ways of one shape turn by the same angle, to 15 degrees, over the same length, to 2 m."""
    yaw = np.unwrap(headings(lane.centerline))
    return round(float(yaw[-1] - yaw[0]) / np.radians(15)), round(lane_length(lane) / 2)


def _tightness(lane: Lane) -> float:
    """Largest curvature of a lane [1/m]."""
    return float(np.abs(curvatures(lane.centerline)).max())


def _route(town: Town, way: _Way) -> Route:
    before, after = (lane_length(town.lanes[name]) for name in (way.before, way.after))
    chain: Sequence[str] = (way.before, way.lane.id, way.after)
    return lay(town, chain, start=max(before - APPROACH, 0.0), end=min(APPROACH, after))
