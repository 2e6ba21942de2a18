import dataclasses

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.config import PidConfig
from mjdrive.datatypes import Lane, Route, Signal, Situation, Town, TrafficLight, VehicleState
from mjdrive.expert import reference

CONFIG = PidConfig()
RADIUS = 8.0


def bend() -> Route:
    """50 m straight east, a left quarter of a circle, 50 m north."""
    angle = np.linspace(0, np.pi / 2, 50)
    arc = np.array([50.0, RADIUS]) + RADIUS * np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    points = geometry.resample(np.vstack([[0.0, 0.0], arc, arc[-1] + [0.0, 50.0]]), 1.0)
    index = (geometry.stations(points) > 40.0).astype(int)
    return Route(
        lanes=("approach", "rest"),
        points=points,
        station=geometry.stations(points),
        yaw=geometry.headings(points),
        curvature=geometry.curvatures(points),
        lane_index=index,
    )


LIGHT = TrafficLight(
    "light",
    "approach",
    "j",
    np.array([[40.5, 2.0], [40.5, -2.0]]),
    0.0,
    np.zeros(2),
    ((Signal.GREEN, 10.0),),
    0.0,
)
LANES = {
    "approach": Lane(
        "approach", np.array([[0.0, 0.0], [40.5, 0.0]]), 4.0, ("rest",), None, "light"
    ),
    "rest": Lane("rest", np.array([[40.5, 0.0], [50.0, 0.0]]), 4.0, (), "j", None),
}
TOWN = Town("bend", LANES, {"light": LIGHT}, np.array([0.0, -2.0, 60.0, 60.0]), "")


def situation(*, station: float, speed: float = 6.0, signal: Signal = Signal.RED) -> Situation:
    state = VehicleState(station, 0.0, 0.0, speed, 0.0, 0.0)
    return Situation(0.0, state, bend(), station, 0.0, {"light": signal})


def distance(place: Situation, stopping_for: str = "") -> float | None:
    stop = reference.stop_ahead(
        place,
        reference.stop_lines(TOWN, place.route),
        nose_ahead=3.5,
        config=CONFIG,
        stopping_for=stopping_for,
    )
    assert stop is None or stop.light == "light"
    return None if stop is None else stop.distance


def test_stop_line_lies_at_the_end_of_the_lane():
    (stop,) = reference.stop_lines(TOWN, bend())
    assert stop.light == "light"
    assert stop.station == pytest.approx(40.5)


def test_route_that_ends_on_an_approach_lane_meets_no_stop_line():
    assert reference.stop_lines(TOWN, dataclasses.replace(bend(), lanes=("approach",))) == ()


@pytest.mark.parametrize("signal", [Signal.RED, Signal.YELLOW])
def test_red_and_yellow_stop_the_nose_one_gap_before_the_line(signal):
    assert distance(situation(station=20.0, signal=signal)) == pytest.approx(
        40.5 - 23.5 - CONFIG.stop_gap
    )


def test_green_stops_nobody():
    assert distance(situation(station=20.0, signal=Signal.GREEN)) is None


def test_late_yellow_is_passed_when_stopping_would_be_an_emergency():
    station = 40.5 - 3.5 - 2.0  # nose 2 m before the line at 6 m/s: 9 m/s2
    assert distance(situation(station=station, signal=Signal.YELLOW)) is None


def test_who_has_begun_to_stop_for_a_yellow_goes_on_when_it_has_become_late():
    late = situation(station=40.5 - 3.5 - 2.0, signal=Signal.YELLOW)
    assert distance(late, stopping_for="light") == pytest.approx(2.0 - CONFIG.stop_gap)
    assert distance(late, stopping_for="another") is None


@pytest.mark.parametrize(
    ("speed", "to_line"), [(6.0, 3.0), (1.0, 0.05), (3.0, 0.8), (6.0, 0.0), (2.0, -0.9)]
)
def test_red_is_stopped_for_however_late_it_is(speed, to_line):
    late = situation(station=40.5 - 3.5 - to_line, speed=speed, signal=Signal.RED)
    assert distance(late) == pytest.approx(to_line - CONFIG.stop_gap)


def test_light_that_lies_behind_asks_for_nothing():
    assert distance(situation(station=40.5 - 3.5 + 1.1, signal=Signal.RED)) is None


def test_car_that_waits_with_its_nose_just_over_the_line_goes_on_waiting():
    assert distance(situation(station=40.5 - 3.5 + 0.3, speed=0.0)) is not None


def test_speed_falls_to_the_bends_speed_by_planned_braking():
    bend_speed = min(CONFIG.turn_speed, np.sqrt(CONFIG.lateral_acceleration * RADIUS))
    assert reference.turn_speed_limit(situation(station=20.0), CONFIG) == CONFIG.target_speed
    assert reference.turn_speed_limit(situation(station=55.0), CONFIG) == pytest.approx(
        bend_speed, rel=0.02
    )
    before = reference.turn_speed_limit(situation(station=48.0), CONFIG)
    assert bend_speed < before < CONFIG.target_speed
    assert before**2 <= bend_speed**2 + 2 * CONFIG.braking * 2.5


def test_point_ahead_runs_along_the_route_and_stops_at_its_end():
    route = bend()
    np.testing.assert_allclose(reference.point_ahead(route, 12.25), [12.25, 0.0], atol=1e-9)
    np.testing.assert_allclose(reference.point_ahead(route, 1e6), route.points[-1])
