import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.config import PidConfig
from mjdrive.datatypes import Lane, Route, Situation, Town, VehicleState
from mjdrive.expert import reference
from mjdrive.expert.speed_profile import SpeedProfile, speed_limits

LAW = PidConfig()
RADIUS = 8.0


def bend() -> Route:
    """50 m straight east, a left quarter of a circle, 50 m north."""
    angle = np.linspace(0, np.pi / 2, 50)
    arc = np.array([50.0, RADIUS]) + RADIUS * np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    points = geometry.resample(np.vstack([[0.0, 0.0], arc, arc[-1] + [0.0, 50.0]]), 1.0)
    return Route(
        lanes=("lane",),
        points=points,
        station=geometry.stations(points),
        yaw=geometry.headings(points),
        curvature=geometry.curvatures(points),
        lane_index=np.zeros(len(points), int),
    )


ROUTE = bend()
LANES = {"lane": Lane("lane", np.array(ROUTE.points), 3.5, (), None, None)}
TOWN = Town("bend", LANES, {}, np.array([0.0, -2.0, 60.0, 60.0]), "")
PROFILE = SpeedProfile(
    TOWN, ROUTE, config=LAW, braking=LAW.braking, acceleration=1.8, max_braking=7.0
)


def test_both_experts_read_the_same_limit_from_a_bend():
    stations = np.arange(0.0, 100.0, 1.0)
    state = VehicleState(*np.zeros(6).tolist())
    expected = [
        reference.turn_speed_limit(Situation(0.0, state, ROUTE, float(it), 0.0, {}), LAW)
        for it in stations
    ]
    found = [PROFILE.limit(float(it)) for it in stations]
    differs = np.abs(np.array(found) - expected) > 0.05
    assert differs.sum() <= 1, "expected them to differ at most where the bend is just over"


def test_limit_before_a_slower_stretch_is_planned_braking():
    station = np.arange(0.0, 21.0)
    speeds = np.where(station < 20.0, 10.0, 4.0)
    found = speed_limits(station, speeds, braking=2.0)
    np.testing.assert_allclose(found, np.minimum(10.0, np.sqrt(16.0 + 4.0 * (20.0 - station))))


def test_reference_comes_to_rest_at_the_stop_with_even_braking():
    plan = PROFILE.reference(
        station=10.0, speed=5.0, distance_to_stop=8.0, num_steps=80, interval=0.05
    )
    assert plan.station[-1] == pytest.approx(18.0, abs=0.1)
    assert plan.speed[-1] == pytest.approx(0.0, abs=0.05)
    assert np.diff(plan.speed).min() / 0.05 > -1.5 * LAW.braking


def test_late_stop_is_braked_for_as_hard_as_it_needs():
    plan = PROFILE.reference(
        station=10.0, speed=6.0, distance_to_stop=4.0, num_steps=60, interval=0.05
    )
    assert plan.station[-1] < 14.3
    assert np.diff(plan.speed).min() / 0.05 == pytest.approx(-36.0 / 8.0, rel=0.25)


def test_reference_accelerates_no_faster_than_told_and_knows_the_road_ahead():
    plan = PROFILE.reference(
        station=40.0, speed=0.0, distance_to_stop=None, num_steps=60, interval=0.1
    )
    assert np.diff(plan.speed).max() <= 0.18 + 1e-9
    assert plan.curvature.max() == pytest.approx(1 / RADIUS, rel=0.02)
    assert (plan.lane_width == 3.5).all()


def test_car_astray_comes_down_to_the_cap():
    plan = PROFILE.reference(
        station=5.0, speed=6.0, distance_to_stop=None, cap=3.0, num_steps=20, interval=0.1
    )
    assert plan.speed[-1] == pytest.approx(3.0)
    assert np.diff(plan.speed).min() == pytest.approx(-0.4)
