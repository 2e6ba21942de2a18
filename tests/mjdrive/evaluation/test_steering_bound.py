"""The least whiteness obeys laws that need no simulation."""

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.datatypes import Route
from mjdrive.evaluation.steering_bound import Least, least_whiteness
from mjdrive.vehicle.parameters import VehicleParameters

SPEED, INTERVAL = 4.0, 0.1


def route_of(points: np.ndarray) -> Route:
    points = geometry.resample(points, 1.0)
    return Route(
        lanes=("lane",),
        points=points,
        station=geometry.stations(points),
        yaw=geometry.headings(points),
        curvature=geometry.curvatures(points),
        lane_index=np.zeros(len(points), int),
    )


def bend() -> Route:
    """20 m east, a quarter of a circle of 8 m to the left, 20 m north."""
    angle = np.linspace(0.0, np.pi / 2, 40)
    arc = np.array([20.0, 8.0]) + 8.0 * np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    return route_of(np.vstack([[0.0, 0.0], arc, arc[-1] + [0.0, 20.0]]))


def least(route: Route, *, allowance: float = 0.1, pace: float = 1.0) -> Least:
    station = np.arange(0.0, float(route.station[-1]), SPEED * INTERVAL)
    return least_whiteness(
        route,
        station,
        np.full(len(station), SPEED),
        car=VehicleParameters.default(),
        allowance=allowance,
        interval=INTERVAL,
        pace=pace,
    )


def test_straight_road_needs_no_steering() -> None:
    assert least(route_of(np.array([[0.0, 0.0], [40.0, 0.0]]))).whiteness < 1e-4


def test_room_makes_steering_smoother_and_both_starts_agree() -> None:
    narrow, wide = least(bend(), allowance=0.05), least(bend(), allowance=0.25)
    assert wide.whiteness < 0.9 * narrow.whiteness
    for it in (narrow, wide):
        assert it.other_start == pytest.approx(it.whiteness, rel=1e-3)


def test_half_the_pace_halves_the_rate_and_doubles_the_time() -> None:
    whole, half = least(bend()), least(bend(), pace=0.5)
    assert half.whiteness == pytest.approx(0.5 * whole.whiteness, rel=0.1)
    assert half.duration == pytest.approx(2 * whole.duration, abs=0.2)
