"""Demonstrations: an expert drives a route of a town, or takes random turns."""

import dataclasses
from collections.abc import Callable

import numpy as np

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Episode, Policy, Route, Situation, Town
from mjdrive.episodes.disturbance import Disturbance
from mjdrive.episodes.recovery import DEVIATIONS, RECOVERED, RouteWatch, recoveries
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute, FollowWalk
from mjdrive.errors import RouteError
from mjdrive.expert.experts import make_expert
from mjdrive.expert.solves import SolveWatch
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import routing
from mjdrive.town.random_walk import RandomWalk

_RUN_OUT = 50.0
"""How far the lanes must lead on where a random walk may end [m]."""

_LEAST_STEPS = 600
"""Control steps allowed however short a drive is: it may begin before a red light [-]."""


def expert_of(config: CollectConfig, simulation: Simulation) -> Policy[Situation]:
    """Make the expert that a collection names, for the car of a simulation.

    Raises:
        SolverError: If the solver of the MPC expert is missing.
    """
    return make_expert(
        config.expert,
        simulation.town,
        parameters=simulation.car.parameters,
        settings=config.pid if config.expert == "pid" else config.mpc,
        control_interval=simulation.config.control_interval,
        law=config.pid,
    )


def collect_route(
    simulation: Simulation,
    route: Route,
    *,
    config: CollectConfig,
    seed: int,
    expert: Policy[Situation] | None = None,
    on_step: Callable[[int], None] | None = None,
) -> Episode:
    """Let an expert drive one route from its start to its end.

    Args:
        simulation: World to drive in; it is reset.
        route: Path to follow, starting on the centre of its first lane.
        config: Expert and disturbance.
        seed: Decides lights and disturbances.
        expert: Who drives; made from the settings if None, which for some experts takes a while.
        on_step: Told the number of control steps done.

    Returns:
        The demonstration; its labels are the expert's clean actions.

    Raises:
        RouteError: If something stands at the start, or the expert does not reach the end in time.
    """
    place_at_start(simulation, route, seed=seed)
    length = float(route.station[-1])
    follow = FollowRoute(route)
    episode = _drive(
        simulation,
        follow,
        stop=lambda: follow.is_finished,
        length=length,
        config=config,
        seed=seed,
        expert=expert,
        on_step=on_step,
    )
    _require_arrived(follow.is_finished, follow.station, length, episode)
    return episode


def collect_walk(
    simulation: Simulation,
    *,
    length: float,
    config: CollectConfig,
    seed: int,
    expert: Policy[Situation] | None = None,
    on_step: Callable[[int], None] | None = None,
) -> Episode:
    """Let an expert take random turns from a random place.

    Args:
        simulation: World to drive in; it is reset.
        length: How far to drive [m].
        config: Expert and disturbance.
        seed: Decides start, turns, lights and disturbances.
        expert: Who drives; made from the settings if None, which for some experts takes a while.
        on_step: Told the number of control steps done.

    Returns:
        The demonstration; its labels are the expert's clean actions.

    Raises:
        RouteError: If the lanes do not lead on for long enough, or the expert does not get that far in time.
    """
    walk = begin_walk(simulation.town, length=length, seed=seed)
    place_at_start(simulation, walk.route, seed=seed)
    follow = FollowWalk(walk)
    episode = _drive(
        simulation,
        follow,
        stop=lambda: follow.station >= length,
        length=length,
        config=config,
        seed=seed,
        expert=expert,
        on_step=on_step,
    )
    _require_arrived(follow.station >= length, follow.station, length, episode)
    return episode


def begin_walk(town: Town, *, length: float, seed: int) -> RandomWalk:
    """Draw where a random walk starts and how it turns.

    Args:
        town: Where it leads.
        length: How far it is driven [m].
        seed: Decides start and turns.

    Raises:
        RouteError: If the lanes do not lead on for long enough.
    """
    far_enough = length + _RUN_OUT
    lane, station = routing.random_start(town, np.random.default_rng([seed, 2]), length=far_enough)
    turns = np.random.default_rng([seed, 3])
    return RandomWalk(town, lane=lane, station=station, rng=turns, length=far_enough)


def place_at_start(simulation: Simulation, route: Route, *, seed: int) -> None:
    """Put the car at rest where a route begins.

    Raises:
        RouteError: If something stands there.
    """
    x, y = route.points[0]
    simulation.place(x=float(x), y=float(y), yaw=float(route.yaw[0]), seed=seed)


def _drive(
    simulation: Simulation,
    view: Callable[[Simulation], Situation],
    *,
    stop: Callable[[], bool],
    length: float,
    config: CollectConfig,
    seed: int,
    expert: Policy[Situation] | None,
    on_step: Callable[[int], None] | None,
) -> Episode:
    """Drive on from where the car stands, disturbed as the settings say."""
    interval = simulation.config.control_interval
    disturbance = None
    if config.disturbance is not None:
        rng = np.random.default_rng([seed, 1])
        disturbance = Disturbance(config.disturbance, rng, interval=interval)
    watch = RouteWatch(view)
    expert = expert or expert_of(config, simulation)
    solves = SolveWatch(expert)
    episode = rollout(
        simulation,
        expert,
        watch,
        num_steps=max(int(config.step_limit_per_metre * length), _LEAST_STEPS),
        seed=seed,
        disturbance=disturbance,
        stop=stop,
        on_step=on_step,
    )
    metadata = {**episode.metadata, **solves.metadata()}
    if disturbance is not None:
        found = recoveries(
            episode, offset=np.array(watch.offset), heading_error=np.array(watch.heading_error)
        )
        metadata |= {DEVIATIONS: str(found.deviations), RECOVERED: str(found.recovered)}
    return dataclasses.replace(episode, metadata=metadata)


def _require_arrived(arrived: bool, station: float, length: float, episode: Episode) -> None:
    if not arrived:
        raise RouteError(
            f"The expert got {station:.0f} m along a route of {length:.0f} m in {len(episode.time)} steps. "
            f"Expected it to arrive; try less disturbance."
        )
