import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Lane, Signal, Town, TrafficLight
from mjdrive.simulation.markings import DASH_LENGTH, DASH_WIDTH, centre_dashes, stop_bars


def lane(name: str, points: list[list[float]], *, junction: str | None = None) -> Lane:
    return Lane(
        id=name,
        centerline=np.array(points),
        width=4.0,
        successors=(),
        junction=junction,
        light=None,
    )


@pytest.fixture
def street() -> Town:
    """Two opposite lanes along the x axis and one in a junction; a light ends the eastbound one."""
    lanes = [
        lane("east", [[0.0, -2.0], [60.0, -2.0]]),
        lane("west", [[60.0, 2.0], [0.0, 2.0]]),
        lane("crossing", [[60.0, -2.0], [75.0, -2.0]], junction="1"),
    ]
    light = TrafficLight(
        id="1",
        lane="east",
        junction="1",
        stop_line=np.array([[60.0, 0.0], [60.0, -4.0]]),
        yaw=0.0,
        pole=np.array([60.0, -5.0]),
        program=((Signal.GREEN, 1.0),),
        offset=0.0,
    )
    return Town(
        name="street",
        lanes={each.id: each for each in lanes},
        lights={"1": light},
        bounds=np.array([0.0, -4.0, 75.0, 4.0]),
        digest="",
    )


def test_opposite_lanes_share_one_broken_line_between_them(street):
    dashes = centre_dashes(street)
    assert len(dashes) == 10
    for dash in dashes:
        assert np.ptp(dash[:, 0]) == pytest.approx(DASH_LENGTH)
        assert dash[:, 1] == pytest.approx(0.5 * DASH_WIDTH * np.array([-1, -1, 1, 1]))


def test_stop_bar_lies_on_the_lane_before_the_stop_line(street):
    (bar,) = stop_bars(street)
    approach = shapely.box(0.0, -4.0, 60.0, 0.0)
    assert approach.buffer(1e-9).contains(shapely.Polygon(bar))
    assert bar[:, 0].max() == pytest.approx(60.0)


def test_paint_faces_the_sky(street):
    for quad in (*centre_dashes(street), *stop_bars(street)):
        assert shapely.LinearRing(quad).is_ccw
