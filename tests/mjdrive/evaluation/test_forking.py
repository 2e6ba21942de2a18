import math

import pytest

from mjdrive.datatypes import Action, Move, Observation, Signal, Town
from mjdrive.evaluation.choices import approaches
from mjdrive.evaluation.forking import (
    FARTHEST,
    SLOWEST,
    Fork,
    ForkOutcome,
    find_forks,
    mean_outcome,
    mean_taken,
    outcome,
)
from mjdrive.simulation.simulation import Simulation


class Steers:
    """Holds the wheel at one of some angles, drawn for each rollout."""

    name = "steers"

    def __init__(self, *steering: float) -> None:
        self._choices = steering
        self._steering = 0.0

    def reset(self, seed: int) -> None:
        self._steering = self._choices[seed % len(self._choices)]

    def act(self, view: Observation) -> Action:
        speed = float(view.state[0])
        return Action(acceleration=0.3 if speed < 4.0 else 0.0, steering=self._steering)


@pytest.fixture(scope="module")
def simulation(town02: Town) -> Simulation:
    return Simulation(town02)


@pytest.fixture(scope="module")
def forks(simulation: Simulation) -> tuple[Fork, ...]:
    names = [it.lane for it in approaches(simulation.town)[:4]]
    return find_forks(simulation, seed=1, names=names)


def test_moments_lie_before_a_green_junction_and_differ(
    forks: tuple[Fork, ...], simulation: Simulation, town02: Town
) -> None:
    assert [fork.approach for fork in forks] == [it.lane for it in approaches(town02)[:4]]
    for fork in forks:
        simulation.restore(fork.snapshot)
        lane = town02.lanes[fork.approach]
        car = simulation.vehicle
        assert FARTHEST - 1.0 < math.dist((car.x, car.y), lane.centerline[-1]) < FARTHEST + 0.1
        assert car.speed > SLOWEST
        assert lane.light is None or simulation.lights[lane.light] is Signal.GREEN
        assert len(fork.exits) > 1


def test_who_goes_straight_on_has_no_entropy_where_that_is_an_exit(
    forks: tuple[Fork, ...], simulation: Simulation, town02: Town
) -> None:
    fork = next(
        fork
        for fork in forks
        if any(town02.lanes[name].move is Move.STRAIGHT for name in fork.exits)
    )
    found = outcome(simulation, fork, Steers(0.0), seed=0, num_rollouts=3)
    (straight,) = (name for name in fork.exits if town02.lanes[name].move is Move.STRAIGHT)
    assert (found.safe, found.entropy) == (1.0, 0.0)
    assert found.taken == {name: 3 * (name == straight) for name in fork.exits}


def test_who_steers_into_a_wall_is_not_safe(
    forks: tuple[Fork, ...], simulation: Simulation
) -> None:
    found = outcome(simulation, forks[0], Steers(-1.0), seed=0, num_rollouts=2)
    assert (found.safe, found.entropy, sum(found.taken.values())) == (0.0, None, 0)


def test_same_seed_lives_the_same_moments(forks: tuple[Fork, ...], simulation: Simulation) -> None:
    policy = Steers(0.0, 0.3, -0.3)
    first = outcome(simulation, forks[0], policy, seed=7, num_rollouts=4)
    assert outcome(simulation, forks[0], policy, seed=7, num_rollouts=4) == first


def test_who_stops_is_safe_and_takes_no_exit() -> None:
    stopped = ForkOutcome("a", 10, 1.0, {"l": 0, "r": 0}, None)
    drove = ForkOutcome("b", 10, 0.9, {"l": 5, "r": 4}, 0.99)
    assert mean_outcome([stopped])[0] == 1.0
    assert mean_taken([stopped]) == 0.0
    assert mean_taken([stopped, drove]) == pytest.approx(0.45)


def test_means_leave_out_moments_without_a_choice() -> None:
    safe = ForkOutcome("a", 10, 1.0, {"l": 5, "r": 5}, 1.0)
    crashed = ForkOutcome("b", 10, 0.0, {"l": 0, "r": 0}, None)
    assert mean_outcome([safe, crashed]) == (0.5, 1.0)
    assert mean_outcome([crashed]) == (0.0, None)
