from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.errors import TownFormatError
from mjdrive.geometry import stations
from mjdrive.town import opendrive
from mjdrive.town.opendrive import lane_geometry
from mjdrive.town.opendrive.cross_section import CrossSections, Cubics, LaneOfRoad, section_bounds
from mjdrive.town.opendrive.lane_geometry import (
    CHORD_ERROR,
    LARGEST_GAP,
    lane_centres,
    lane_outer_edges,
)
from mjdrive.town.opendrive.reference_line import reference_line
from mjdrive.town.opendrive.road_map import LaneRecord, LaneSection, Road
from mjdrive.town.opendrive.road_shapes import (
    Arc,
    Cubic,
    Line,
    ParamPoly3,
    Piece,
    Poly3,
    Shape,
    Spiral,
)

LANES = (
    LaneRecord(1, "driving", (Cubic(0.0, 4.0),)),
    LaneRecord(0, "none"),
    LaneRecord(-1, "driving", (Cubic(0.0, 4.0),)),
)


def _road(piece: Piece) -> Road:
    return Road("1", "", piece.length, None, (piece,), (), (LaneSection(0.0, LANES),))


def lane_centre(road: Road, section: int, lane: int) -> tuple[np.ndarray, np.ndarray]:
    (line,) = lane_centres([LaneOfRoad(road, section, lane)])
    return line


def lane_edge(road: Road, section: int, lane: int) -> np.ndarray:
    (line,) = lane_outer_edges([LaneOfRoad(road, section, lane)])
    return line


def lane_edges(road: Road, section: int, lane: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    lanes = CrossSections([LaneOfRoad(road, section, lane)])
    return lanes.edges(np.zeros(len(s), dtype=int), s)


def test_cubics_hold_from_their_start_to_the_next() -> None:
    cubics = [Cubic(0.0, 1.0), Cubic(2.0, 5.0, 1.0, -1.0, 0.5)]
    values = Cubics([(), cubics]).at(np.array([1, 1, 1, 1, 0]), np.array([0.0, 1.9, 2.0, 4.0, 4.0]))
    np.testing.assert_allclose(values, [1.0, 1.0, 5.0, 5.0 + 2.0 - 4.0 + 4.0, 0.0])


def test_lanes_come_out_the_same_together_and_alone(
    rich_bytes: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    lanes = [
        LaneOfRoad(road, index, lane.id)
        for road in opendrive.parse(rich_bytes, source="rich").roads.values()
        for index, section in enumerate(road.sections)
        for lane in section.lanes
    ]
    together = list(lane_outer_edges(lanes))
    monkeypatch.setattr(lane_geometry, "_AT_ONCE", 300)
    in_parts = list(lane_outer_edges(lanes))
    assert len(together) == len(in_parts) == len(lanes) > 20
    for line, part, lane in zip(together, in_parts, lanes, strict=True):
        for other in (part, lane_edge(*lane)):
            np.testing.assert_allclose(line, other, rtol=0.0, atol=1e-9)


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
        away = np.max(lane_radius - np.hypot(middles[:, 0], middles[:, 1] - radius))
        assert away <= CHORD_ERROR * (1.0 + 1e-6)
        assert np.max(np.diff(stations(points))) <= LARGEST_GAP * (1.0 + 1e-6)


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


@pytest.mark.parametrize(
    "shape",
    [
        Line(),
        Arc(-0.08),
        Spiral(-0.1, 0.12),
        Poly3(0.0, 0.0, 0.02, -0.0004),
        ParamPoly3((0.0, 28.0, 0.0, -4.0), (0.0, 0.0, 20.0, -10.0), is_normalized=True),
    ],
)
def test_lanes_of_any_shape_keep_to_half_a_millimetre(shape: Shape) -> None:
    widening = LaneRecord(-1, "driving", (Cubic(0.0, 3.0, 0.0, 0.004, -0.0001),))
    road = replace(
        _road(Piece(0.0, 5.0, 5.0, 1.0, 30.0, shape)),
        lane_offsets=(Cubic(0.0, 0.0), Cubic(7.3, 0.0, 0.0, 0.02, -0.001)),
        sections=(LaneSection(0.0, (LaneRecord(0, "none"), widening)),),
    )
    points, _ = lane_centre(road, 0, -1)
    # The curve by brute force: points every millimetre.
    s = np.arange(0.0, 30.0, 0.001)
    inner, outer = lane_edges(road, 0, -1, s)
    centre, heading = reference_line(road.pieces, s)
    normal = np.stack([-np.sin(heading), np.cos(heading)], axis=1)
    curve = centre + (0.5 * (inner + outer))[:, None] * normal
    away = shapely.distance(shapely.LineString(points), shapely.points(curve))
    assert away.max() <= CHORD_ERROR * 1.02
    assert np.diff(stations(points)).max() <= LARGEST_GAP * (1.0 + 1e-6)


def test_borders_say_the_same_as_widths() -> None:
    by_width = _road(Piece(0.0, 0.0, 0.0, 0.0, 20.0, Arc(0.05)))
    lanes = tuple(
        replace(lane, widths=(), borders=(Cubic(0.0, 4.0 * lane.id),)) if lane.id else lane
        for lane in LANES
    )
    by_border = replace(by_width, sections=(LaneSection(0.0, lanes),))
    for lane in (1, -1):
        for one, other in zip(
            lane_centre(by_width, 0, lane), lane_centre(by_border, 0, lane), strict=True
        ):
            np.testing.assert_allclose(one, other, atol=1e-12)


def test_a_border_counts_from_the_reference_line() -> None:
    lanes = (LaneRecord(0, "none"), LaneRecord(-1, "driving", borders=(Cubic(0.0, -4.0),)))
    road = replace(
        _road(Piece(0.0, 0.0, 0.0, 0.0, 20.0)),
        lane_offsets=(Cubic(0.0, 1.0),),
        sections=(LaneSection(0.0, lanes),),
    )
    points, widths = lane_centre(road, 0, -1)
    np.testing.assert_allclose(points[:, 1], -1.5)
    np.testing.assert_allclose(widths, 5.0)


def test_a_negative_width_counts_as_nothing() -> None:
    lanes = (LaneRecord(0, "none"), LaneRecord(-1, "driving", (Cubic(0.0, -1.0, 0.2),)))
    road = replace(_road(Piece(0.0, 0.0, 0.0, 0.0, 10.0)), sections=(LaneSection(0.0, lanes),))
    points, widths = lane_centre(road, 0, -1)
    np.testing.assert_allclose(widths, np.maximum(-1.0 + 0.2 * points[:, 0], 0.0), atol=1e-12)
    assert widths.min() == 0.0


def test_edges_lie_half_a_width_beside_the_centre() -> None:
    road = _road(Piece(0.0, 0.0, 0.0, 0.0, 30.0, Spiral(0.0, 0.1)))
    middle = shapely.LineString(lane_edge(road, 0, 0))
    for lane in (1, -1):
        points, _ = lane_centre(road, 0, lane)
        for line in (middle, shapely.LineString(lane_edge(road, 0, lane))):
            away = shapely.distance(line, shapely.points(points))
            np.testing.assert_allclose(away, 2.0, atol=2 * CHORD_ERROR)


def test_a_jump_in_the_lane_offset_ends_the_search_for_shorter_steps() -> None:
    road = replace(
        _road(Piece(0.0, 0.0, 0.0, 0.0, 10.0)),
        lane_offsets=(Cubic(0.0, 0.0), Cubic(4.2, 1.0)),
    )
    points, _ = lane_centre(road, 0, 1)
    assert len(points) < 60
    assert np.diff(points[:, 0]).min() < 0.002


def test_a_line_that_swings_too_wildly_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lane_geometry, "_MOST_POINTS", 3000)
    swinging = tuple(Cubic(0.1 * n, 3.0, 9e2 * (-1) ** n) for n in range(200))
    lanes = (LaneRecord(0, "none"), LaneRecord(-1, "driving", swinging))
    road = replace(_road(Piece(0.0, 0.0, 0.0, 0.0, 20.0)), sections=(LaneSection(0.0, lanes),))
    with pytest.raises(TownFormatError, match=r"Lane -1 of road '1' needs more than 3000 points"):
        lane_centre(road, 0, -1)


def test_a_border_too_far_out_is_refused() -> None:
    lanes = (LaneRecord(0, "none"), LaneRecord(-1, "driving", (), borders=(Cubic(0.0, -150.0),)))
    road = replace(
        _road(Piece(0.0, 0.0, 0.0, 0.0, 9.0, Line())), sections=(LaneSection(0.0, lanes),)
    )
    with pytest.raises(TownFormatError, match="Lane -1 of road '1' is up to 150 m wide"):
        lane_centre(road, 0, -1)
