"""All rules together; each has a table of its own beside this file."""

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.config import RulesConfig
from mjdrive.datatypes import Infraction, InfractionKind, Signal, Town, VehicleState
from mjdrive.errors import ConfigError
from mjdrive.simulation.rules import Rules
from mjdrive.vehicle.parameters import VehicleParameters

AHEAD = 1.35
"""The centre of the car lies so far ahead of its rear axle [m]."""


@pytest.fixture
def check(crossroads: Town) -> Callable[..., tuple[Infraction, ...]]:
    """One rule book, asked step by step; the centre of the car is at (x, y), all lights are red."""
    rules = Rules(crossroads, VehicleParameters.default(), RulesConfig(stuck_time=10.0))
    red = dict.fromkeys(crossroads.lights, Signal.RED)

    def check(
        time: float, x: float, y: float, *, speed: float = 5.0, hits: tuple = ()
    ) -> tuple[Infraction, ...]:
        vehicle = VehicleState(x - AHEAD, y, 0.0, speed, 0.0, 0.0)
        return rules.check(time=time, vehicle=vehicle, lights=red, hits=hits)

    check.rules = rules  # type: ignore[attr-defined]
    return check


def worst_drive(check: Callable[..., tuple[Infraction, ...]]) -> list[Infraction]:
    """Against the traffic, over the kerb into a pole and off the road, over a red light, and stuck there."""
    found: list[Infraction] = []
    for step in range(12):
        found += check(0.1 * step, -50.0 + 0.5 * step, 2.0)
    touched = ((InfractionKind.COLLISION, "pole_3"), (InfractionKind.KERB, "kerb"))
    found += check(2.0, -44.0, 6.0, hits=touched)
    found += check(3.0, -8.0, -2.0)
    for step in range(12):
        found += check(4.0 + step, -5.0, -2.0, speed=0.0)
    return found


def test_each_kind_is_reported_once_with_time_place_and_cause(check: Callable) -> None:
    assert worst_drive(check) == [
        Infraction(InfractionKind.WRONG_WAY, 1.0, -45.0 - AHEAD, 2.0, "west out"),
        Infraction(InfractionKind.COLLISION, 2.0, -44.0 - AHEAD, 6.0, "pole_3"),
        Infraction(InfractionKind.KERB, 2.0, -44.0 - AHEAD, 6.0, "kerb"),
        Infraction(InfractionKind.OFF_ROAD, 2.0, -44.0 - AHEAD, 6.0, "west out"),
        Infraction(InfractionKind.RED_LIGHT, 3.0, -8.0 - AHEAD, -2.0, "west in"),
        Infraction(InfractionKind.STUCK, 14.0, -5.0 - AHEAD, -2.0, "standstill"),
    ]


def test_reset_forgets_the_drive(check: Callable) -> None:
    first = worst_drive(check)
    check.rules.reset()
    assert worst_drive(check) == first


def test_a_car_in_its_lane_is_on_a_lane(crossroads: Town) -> None:
    rules = Rules(crossroads, VehicleParameters.default())
    state = VehicleState(-30.0 - AHEAD, -2.0, 0.0, 0.0, 0.0, 0.0)
    assert rules.on_lane(state)
    assert not rules.on_lane(dataclasses.replace(state, y=-4.1))
    # The centre counts, not the rear axle.
    across = VehicleState(-30.0, -3.0, -np.pi / 2, 0.0, 0.0, 0.0)
    assert not rules.on_lane(across)


def test_driving_along_the_middle_of_every_lane_breaks_no_rule(town02: Town) -> None:
    rules = Rules(town02, VehicleParameters.default())
    green = dict.fromkeys(town02.lights, Signal.GREEN)
    for lane in town02.lanes.values():
        rules.reset()
        points = geometry.resample(lane.centerline, 2.0)
        for step, (centre, yaw) in enumerate(
            zip(points, geometry.headings(points).tolist(), strict=True)
        ):
            x, y = (centre - AHEAD * np.array([np.cos(yaw), np.sin(yaw)])).tolist()
            vehicle = VehicleState(x, y, yaw, 10.0, 0.0, 0.0)
            assert rules.check(time=0.1 * step, vehicle=vehicle, lights=green, hits=()) == (), lane
            assert rules.on_lane(vehicle)


def test_driving_every_street_backwards_is_the_wrong_way(town02: Town) -> None:
    rules = Rules(town02, VehicleParameters.default())
    green = dict.fromkeys(town02.lights, Signal.GREEN)
    streets = [lane for lane in town02.lanes.values() if lane.junction is None]
    for lane in streets:
        rules.reset()
        found: list[Infraction] = []
        points = geometry.resample(lane.centerline[::-1], 1.0)[1:-1]
        for step, ((x, y), yaw) in enumerate(
            zip(points.tolist(), geometry.headings(points).tolist(), strict=True)
        ):
            vehicle = VehicleState(
                x - AHEAD * np.cos(yaw), y - AHEAD * np.sin(yaw), yaw, 10.0, 0.0, 0.0
            )
            found += rules.check(time=0.1 * step, vehicle=vehicle, lights=green, hits=())
        assert [(it.kind, it.cause) for it in found] == [(InfractionKind.WRONG_WAY, lane.id)]
    assert len(streets) > 10


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        ("stop_line_share", 0.0),
        ("stop_line_share", 1.1),
        ("light_distance", 0.0),
        ("wrong_way_angle", 1.0),
        ("wrong_way_angle", np.pi),
        ("wrong_way_distance", -1.0),
        ("back_on_road", -0.1),
        ("same_hit_time", -1.0),
        ("stuck_time", 0.0),
        ("stuck_speed", 0.0),
    ],
)
def test_settings_out_of_range_are_refused_by_name(setting: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"{setting} is "):
        RulesConfig(**{setting: float(value)})
