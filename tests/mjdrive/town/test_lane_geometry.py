from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.geometry import stations
from mjdrive.town.lane_geometry import (
    LARGEST_GAP,
    evaluate,
    lane_centre,
    reference_line,
    section_bounds,
)
from mjdrive.town.road_map import LaneRecord, LaneSection, Road
from mjdrive.town.road_shapes import Arc, Cubic, Piece

LANES = (
    LaneRecord(1, "driving", (Cubic(0.0, 4.0),)),
    LaneRecord(0, "none"),
    LaneRecord(-1, "driving", (Cubic(0.0, 4.0),)),
)


def _road(piece: Piece) -> Road:
    return Road("1", "", piece.length, None, (piece,), (), (LaneSection(0.0, LANES),))


def test_cubics_hold_from_their_start_to_the_next() -> None:
    cubics = [Cubic(0.0, 1.0), Cubic(2.0, 5.0, 1.0, -1.0, 0.5)]
    values = evaluate(cubics, np.array([0.0, 1.9, 2.0, 4.0]))
    np.testing.assert_allclose(values, [1.0, 1.0, 5.0, 5.0 + 2.0 - 4.0 + 4.0])


@given(
    radius=st.floats(3.0, 500.0),
    angle=st.floats(0.1, 6.0),
    heading=st.floats(-3.0, 3.0),
    side=st.sampled_from([-1.0, 1.0]),
)
def test_an_arc_stays_on_its_circle(
    radius: float, angle: float, heading: float, side: float
) -> None:
    piece = Piece(0.0, 10.0, -20.0, heading, radius * angle, Arc(side / radius))
    points, headings = reference_line([piece], np.linspace(0.0, piece.length, 50))
    centre = np.array([10.0, -20.0]) + side * radius * np.array([-np.sin(heading), np.cos(heading)])
    np.testing.assert_allclose(np.hypot(*(points - centre).T), radius, rtol=1e-9)
    np.testing.assert_allclose(headings, heading + side * np.linspace(0.0, angle, 50), atol=1e-9)


@pytest.mark.parametrize("radius", [5.0, 10.0, 80.0])
def test_lanes_beside_an_arc_are_concentric_and_dense(radius: float) -> None:
    road = _road(Piece(0.0, 0.0, 0.0, 0.0, radius * np.pi / 2, Arc(1.0 / radius)))
    for lane, lane_radius in ((1, radius - 2.0), (-1, radius + 2.0)):
        points, width = lane_centre(road, 0, lane)
        np.testing.assert_allclose(
            np.hypot(points[:, 0], points[:, 1] - radius), lane_radius, rtol=1e-9
        )
        np.testing.assert_array_equal(width, 4.0)
        middles = 0.5 * (points[1:] + points[:-1])
        assert np.max(lane_radius - np.hypot(middles[:, 0], middles[:, 1] - radius)) < 0.001
        assert np.max(np.diff(stations(points))) <= LARGEST_GAP * lane_radius / radius


def test_a_lane_follows_lane_offset_and_width() -> None:
    road = replace(
        _road(Piece(0.0, 0.0, 0.0, 0.0, 10.0)),
        lane_offsets=(Cubic(0.0, 1.0, 0.1),),
        sections=(
            LaneSection(
                0.0, (LaneRecord(0, "none"), LaneRecord(-1, "driving", (Cubic(0.0, 2.0, 0.2),)))
            ),
        ),
    )
    points, width = lane_centre(road, 0, -1)
    np.testing.assert_allclose(width, 2.0 + 0.2 * points[:, 0])
    np.testing.assert_allclose(points[:, 1], 1.0 + 0.1 * points[:, 0] - 0.5 * width)


def test_sections_end_where_the_next_begins() -> None:
    road = replace(
        _road(Piece(0.0, 0.0, 0.0, 0.0, 10.0)),
        sections=(LaneSection(0.0, LANES), LaneSection(4.0, LANES)),
    )
    assert [section_bounds(road, index) for index in (0, 1)] == [(0.0, 4.0), (4.0, 10.0)]
    first, second = (lane_centre(road, index, 1)[0] for index in (0, 1))
    np.testing.assert_allclose(first[-1], second[0])
