"""Rewards and figures against closed forms and against `mjdrive.evaluation.metrics`."""

import math

import pytest

from mjdrive.config import EnvConfig, RewardConfig
from mjdrive.datatypes import Action, Infraction, InfractionKind, VehicleState
from mjdrive.envs import rewards
from mjdrive.envs.lane_sense import LaneSense
from mjdrive.envs.tally import Tally
from mjdrive.episodes.driving import drive_expert
from mjdrive.evaluation.metrics import summarise
from mjdrive.simulation.simulation import Simulation


def car(
    x: float = 0.0, *, yaw: float = 0.0, speed: float = 5.0, yaw_rate: float = 0.0
) -> VehicleState:
    return VehicleState(x=x, y=0.0, yaw=yaw, speed=speed, yaw_rate=yaw_rate, steering_angle=0.0)


def weigh(before: VehicleState, after: VehicleState, **words: object) -> dict[str, float]:
    settings = {"in_lane": True, "infractions": (), "interval": 0.1, **words}
    return rewards.terms(RewardConfig(), before=before, after=after, **settings)  # type: ignore[arg-type]


def test_progress_is_a_tenth_a_metre_and_reversing_takes_it_back() -> None:
    assert weigh(car(), car(0.5))["progress"] == pytest.approx(0.05)
    assert weigh(car(), car(-0.5))["progress"] == pytest.approx(-0.05)
    assert weigh(car(yaw=math.pi / 2), car(0.5))["progress"] == pytest.approx(0.0)
    assert weigh(car(), car(0.5), in_lane=False)["progress"] == 0.0


def test_racing_does_not_pay() -> None:
    assert weigh(car(), car(3.0))["progress"] == weigh(car(), car(0.8))["progress"]


def test_comfort_counts_squared_acceleration_along_and_across() -> None:
    # 2 m/s2 along and 5 m/s x 0.4 rad/s = 2 m/s2 across, for 0.1 s: 0.01 s3/m2 x 8 m2/s4 x 0.1 s
    assert weigh(car(speed=4.8), car(speed=5.0, yaw_rate=0.4))["comfort"] == pytest.approx(-0.008)
    assert weigh(car(), car())["comfort"] == 0.0


@pytest.mark.parametrize("kind", InfractionKind)
def test_each_infraction_costs_what_its_setting_says(kind: InfractionKind) -> None:
    infraction = Infraction(kind, 0.0, 0.0, 0.0, "it")
    weighed = weigh(car(), car(), infractions=(infraction, infraction))
    name = kind.name.lower()
    assert weighed.pop(name) == -2 * getattr(RewardConfig(), name)
    assert set(weighed.values()) == {0.0}
    assert name in EnvConfig.__dataclass_fields__["ends_on"].type.__args__[0].__args__


def test_figures_are_those_of_the_summary(simulation: Simulation) -> None:
    episode = drive_expert(simulation, num_steps=120, seed=2)
    states = [VehicleState(*row) for row in episode.vehicle.tolist()]
    tally = Tally(states[0], on_lane=bool(episode.on_lane[0]))
    for state, on_lane in zip(states[1:], episode.on_lane[1:], strict=True):
        tally.add(state, (), on_lane=bool(on_lane))
    assert round(tally.distance, 4) == summarise(episode, simulation.town).distance_m > 5.0
    light = Infraction(InfractionKind.RED_LIGHT, 0.0, 0.0, 0.0, "it")
    tally.add(states[-1], (light, light), on_lane=True)
    assert tally.score == pytest.approx(0.49 * tally.distance)


def test_lane_runs_the_way_of_the_car_or_does_not(simulation: Simulation) -> None:
    town = simulation.town
    lane = next(name for name, lane in town.lanes.items() if lane.junction is None)
    simulation.reset(lane=lane, station=1.0, seed=0)
    sense = LaneSense(town, simulation.car.parameters)
    here = simulation.vehicle
    assert sense.follows(here)
    back = VehicleState(here.x, here.y, here.yaw + math.pi, 0.0, 0.0, 0.0)
    assert not sense.follows(back)
    assert sense.follows(here)
    simulation.step(Action(0.0, 0.0))
