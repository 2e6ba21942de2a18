"""Every way through every junction of a town, driven by the PID expert: no kerb, no collision, never off the road."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import InfractionKind, Route, Signal, Situation, Town
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute
from mjdrive.expert.pid import PidExpert
from mjdrive.manoeuvres.bars import Bar
from mjdrive.simulation.simulation import Simulation
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.route_line import lay

TOWN = "town02"
BEFORE, AFTER = 25.0, 15.0  # driven before and after the junction [m]
MOST_STEPS = 600
FORBIDDEN = {InfractionKind.OFF_ROAD, InfractionKind.KERB, InfractionKind.COLLISION}


class MoveDrive(NamedTuple):
    """One way through a junction, driven.

    Attributes:
        lane: The lane that crosses the junction.
        breaches: What went wrong, in words; empty if nothing did.
        largest_offset: Of the rear axle from the route [m].
        arrived: Whether the car got to the end of the route.
    """

    lane: str
    breaches: tuple[str, ...]
    largest_offset: float
    arrived: bool

    @property
    def is_clean(self) -> bool:
        """Whether the car got through without a breach."""
        return self.arrived and not self.breaches


def moves(town: Town) -> list[str]:
    """Names of the lanes that cross the junctions of a town."""
    return [name for name, lane in town.lanes.items() if lane.junction is not None]


def route_over(town: Town, move: str) -> Route:
    """Lay a route over a lane of a junction, with some of the lanes before and after it.

    Args:
        town: The town.
        move: Name of the lane.
    """
    lanes = town.lanes
    before = next(name for name, lane in lanes.items() if move in lane.successors)
    after = lanes[move].successors[0]
    return lay(
        town,
        [before, move, after],
        start=max(lane_length(lanes[before]) - BEFORE, 0.0),
        end=min(lane_length(lanes[after]), AFTER),
    )


class _AllGreen:
    """Follows a route under lights that are always green: signals are no part of this."""

    def __init__(self, route: Route) -> None:
        self.follow = FollowRoute(route)
        self.offsets: list[float] = []

    def __call__(self, simulation: Simulation) -> Situation:
        situation = self.follow(simulation)
        self.offsets.append(abs(situation.offset))
        return dataclasses.replace(situation, lights=dict.fromkeys(situation.lights, Signal.GREEN))


def drive_move(simulation: Simulation, move: str) -> MoveDrive:
    """Drive one way through a junction, from rest.

    Args:
        simulation: World to drive in; it is reset.
        move: Name of the lane in the junction.
    """
    route = route_over(simulation.town, move)
    view = _AllGreen(route)
    expert = PidExpert(
        simulation.town,
        parameters=simulation.car.parameters,
        control_interval=simulation.config.control_interval,
    )
    x, y = route.points[0]
    simulation.place(x=float(x), y=float(y), yaw=float(route.yaw[0]), seed=0)
    episode = rollout(
        simulation, expert, view, num_steps=MOST_STEPS, seed=0, stop=lambda: view.follow.is_finished
    )
    breaches = tuple(
        f"{infraction.kind.name.lower()} ({infraction.cause})"
        for infraction in episode.infractions
        if infraction.kind in FORBIDDEN
    )
    return MoveDrive(move, breaches, float(np.max(view.offsets)), view.follow.is_finished)


def drive_moves(
    simulation: Simulation,
    names: Sequence[str] | None = None,
    on_move: Callable[[], None] = lambda: None,
) -> list[MoveDrive]:
    """Drive ways through the junctions of a town.

    Args:
        simulation: World to drive in.
        names: Lanes to drive; all that cross a junction if None.
        on_move: Called after each.
    """
    driven = []
    for move in names if names is not None else moves(simulation.town):
        driven.append(drive_move(simulation, move))
        on_move()
    return driven


def bars(drives: Sequence[MoveDrive], town: str = TOWN) -> tuple[Bar, ...]:
    """Count the moves that cannot be driven inside the road."""
    broken = [drive for drive in drives if not drive.is_clean]
    worst = max(drives, key=lambda drive: drive.largest_offset)
    reason = "; ".join(
        f"{drive.lane}: {', '.join(drive.breaches) or 'never arrived'}" for drive in broken
    )
    return (
        Bar(
            f"moves of {town}",
            f"not drivable, of {len(drives)}",
            float(len(broken)),
            "moves",
            most=0.0,
            reason=reason or f"largest offset {worst.largest_offset:.2f} m, on {worst.lane}",
        ),
    )
