"""What the physics of one control step costs in a full town, in processor time."""

import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from mjdrive.datatypes import Action, Town
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute
from mjdrive.expert.pid import PidExpert
from mjdrive.manoeuvres.bars import Bar
from mjdrive.simulation.simulation import Simulation, Snapshot
from mjdrive.town import routing
from mjdrive.vehicle.cars import CarModel

TOWN = "town01"
NUM_STEPS = 300
NUM_ROUNDS = 25
SEED = 0
MOST_MS = 0.6  # [ms]


class Cost(NamedTuple):
    """Processor time of the physics of one control step, as means over whole rounds; each drives the same steps again.

    Attributes:
        best_ms: Of the best round: all do the same work bit by bit, so what one takes longer is the doing of other
            programs on the machine [ms].
        median_ms: Of the median round [ms].
    """

    best_ms: float
    median_ms: float


def measure(
    town: Town, *, car: CarModel | None = None, on_round: Callable[[], None] = lambda: None
) -> Cost:
    """Let the PID expert drive once, then repeat its actions with the physics alone, by the clock.

    Args:
        town: Where.
        car: Which car; the default one if None.
        on_round: Called after each round.
    """
    simulation = Simulation(town, car=car)
    start, actions = _record(simulation)
    rounds = []
    for _ in range(NUM_ROUNDS):
        simulation.restore(start)
        rounds.append(1000.0 * _replay(simulation, actions) / len(actions))
        on_round()
    return Cost(min(rounds), float(np.median(rounds)))


def _record(simulation: Simulation) -> tuple[Snapshot, list[Action]]:
    rng = np.random.default_rng(SEED)
    lane, station = routing.random_start(simulation.town, rng, length=1000.0)
    route = routing.random_route(
        simulation.town, lane=lane, station=station, length=1000.0, rng=rng
    )
    simulation.reset(lane=lane, station=station, seed=SEED)
    start = simulation.save()
    expert = PidExpert(simulation.town, parameters=simulation.car.parameters)
    episode = rollout(simulation, expert, FollowRoute(route), num_steps=NUM_STEPS, seed=SEED)
    return start, [Action(*row) for row in episode.actions.tolist()]


def _replay(simulation: Simulation, actions: Sequence[Action]) -> float:
    """Processor time of this thread for the physics of all the steps together [s]."""
    config, car = simulation.config, simulation.car
    num_updates = round(config.control_interval / config.car_update_interval)
    num_steps = round(config.car_update_interval / config.timestep)
    begin = time.thread_time()
    for action in actions:
        car.command(action)
        for _ in range(num_updates):
            car.update()
            mujoco.mj_step(simulation.model, simulation.data, num_steps)
    return time.thread_time() - begin


def bars(cost: Cost, town: str = TOWN) -> tuple[Bar, ...]:
    """Hold the best whole round against 0.6 ms; the median round is shown beside it."""
    return (
        Bar(
            f"cost in {town}",
            "physics of one step of 0.1 s",
            cost.best_ms,
            "ms",
            most=MOST_MS,
            reason=f"processor time, best of {NUM_ROUNDS} drives of {NUM_STEPS} steps; the median one {cost.median_ms:.2f} ms",
        ),
    )
