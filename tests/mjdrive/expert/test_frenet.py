import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.datatypes import Route, Situation, VehicleState
from mjdrive.expert.frenet import frenet_state

RADIUS = 5.0


def circle(*, side: int) -> Route:
    """Most of a circle, to the left (1) or to the right (-1), as a chain of chords of 1 m."""
    angle = np.linspace(0.0, 5.0, 2000)
    arc = RADIUS * np.stack([np.sin(angle), side * (1 - np.cos(angle))], axis=1)
    points = geometry.resample(arc, 1.0)
    return Route(
        lanes=("lane",),
        points=points,
        station=geometry.stations(points),
        yaw=geometry.headings(points),
        curvature=geometry.curvatures(points),
        lane_index=np.zeros(len(points), int),
    )


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("beside", [-0.5, 0.0, 0.5])
def test_car_on_a_circle_keeps_one_offset_and_one_heading_over_all_corners(side, beside):
    route = circle(side=side)
    found = []
    for angle in np.linspace(0.5, 4.3, 200):
        radius = RADIUS - side * beside
        x, y = radius * np.sin(angle), side * (RADIUS - radius * np.cos(angle))
        seen = geometry.project(route.points, np.array([x, y]))
        yaw = geometry.wrap_angle(side * angle + 0.2)
        state = VehicleState(x, y, yaw, 3.0, 0.0, 0.0)
        found.append(frenet_state(Situation(0.0, state, route, seen.station, seen.offset, {})))
    offset, heading_error = np.array(found).T
    np.testing.assert_allclose(offset, beside, atol=0.006)  # the polyline's corners: 0.025 m
    np.testing.assert_allclose(heading_error, 0.2, atol=0.02)
