from typing import Any

import numpy as np
import pytest
import shapely

from mjdrive.town import furniture, library
from mjdrive.town.opendrive.road_map import LaneRecord, ObjectRecord, Road, SignalRecord
from mjdrive.town.opendrive.road_shapes import Cubic, RoadMark


def _road(maker: Any, *lanes: LaneRecord | int, **more: Any) -> Road:
    return maker.road("1", ((0, 0), (50, 0)), maker.section(*lanes), **more)


def _lines(maker: Any, *lanes: LaneRecord | int) -> list[tuple[float, float, float, float]]:
    """Offset, start, end and dash of each marking of a straight road along x [m]."""
    return [
        (
            round(float(marking.points[0, 1]), 6),
            round(float(marking.points[0, 0]), 6),
            round(float(marking.points[-1, 0]), 6),
            marking.dash,
        )
        for marking in furniture.markings(maker.map([_road(maker, *lanes)]))
    ]


def test_a_mark_runs_along_the_outer_edge_of_its_lane(maker: Any) -> None:
    left, right = (maker.lane(number, marks=(RoadMark("solid"),)) for number in (1, -2))
    middle = maker.lane(0, type="none", marks=(RoadMark("broken"),))
    assert _lines(maker, left, middle, -1, right) == [
        (3.5, 0.0, 50.0, 0.0),
        (0.0, 0.0, 50.0, 3.0),
        (-7.0, 0.0, 50.0, 0.0),
    ]


def test_what_the_map_says_of_a_mark_is_kept(maker: Any) -> None:
    mark = RoadMark("broken", color="yellow", width=0.2, dash=4.0, gap=8.0)
    (marking,) = furniture.markings(maker.map([_road(maker, maker.lane(-1, marks=(mark,)))]))
    assert (marking.color, marking.width, marking.dash, marking.gap) == ("yellow", 0.2, 4.0, 8.0)


def test_what_the_map_does_not_say_is_white_and_usual(maker: Any) -> None:
    marked = maker.lane(-1, marks=(RoadMark("broken"),))
    (marking,) = furniture.markings(maker.map([_road(maker, marked)]))
    assert (marking.color, marking.width, marking.dash, marking.gap) == ("white", 0.12, 3.0, 3.0)


def test_marks_change_where_the_map_says_so(maker: Any) -> None:
    marks = (RoadMark("solid"), RoadMark("none", start=10.0), RoadMark("broken", start=30.2))
    assert _lines(maker, maker.lane(-1, marks=marks)) == [
        (-3.5, 0.0, 10.0, 0.0),
        (-3.5, 30.2, 50.0, 3.0),
    ]


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (-1, [(-3.4, 0.0), (-3.6, 3.0)]),
        (1, [(3.4, 0.0), (3.6, 3.0)]),
        (0, [(0.1, 0.0), (-0.1, 3.0)]),
    ],
)
def test_double_lines_run_from_the_inside_out(
    maker: Any, number: int, expected: list[tuple[float, float]]
) -> None:
    mark = RoadMark("solid broken", width=0.1)
    kind = "none" if number == 0 else "driving"
    lanes = [maker.lane(number, type=kind, marks=(mark,)), *({-1, 1} - {number})]
    assert [(line[0], line[3]) for line in _lines(maker, *lanes)] == expected


@pytest.mark.parametrize("kind", ["none", "curb", "grass", "botts dots", "edge"])
def test_kerbs_and_grass_are_no_paint(maker: Any, kind: str) -> None:
    assert _lines(maker, maker.lane(-1, marks=(RoadMark(kind),))) == []


def test_a_sign_faces_the_traffic_that_it_is_for(maker: Any) -> None:
    facts = {"name": "", "type": "274", "from_lane": 0, "to_lane": 0, "value": 50.0, "unit": "km/h"}
    records = (
        SignalRecord(id="on", s=20.0, t=-6.0, orientation="+", dynamic=False, **facts),
        SignalRecord(id="back", s=30.0, t=6.0, orientation="-", dynamic=False, **facts),
        SignalRecord(id="changes", s=30.0, t=6.0, orientation="-", dynamic=True, **facts),
    )
    on, back = furniture.signs(maker.map([_road(maker, -1, signals=records)]))
    assert (on.id, on.type, on.value, on.unit, on.x, on.y) == (
        "on",
        "274",
        50.0,
        "km/h",
        20.0,
        -6.0,
    )
    assert on.yaw == 0.0
    assert (back.id, back.x, back.y) == ("back", 30.0, 6.0)
    assert back.yaw == pytest.approx(np.pi)


def test_objects_with_an_outline_stand_where_the_map_puts_them(maker: Any) -> None:
    corners = ((10.0, 8.0), (14.0, 8.0), (14.0, 11.0))
    house = ObjectRecord("h", "", "building", 12.0, 9.0, 0.0, corners, 7.0)
    point = ObjectRecord("p", "", "pole", 20.0, 9.0, 0.0, (), 4.0)
    (found,) = furniture.objects(maker.map([_road(maker, -1, objects=(house, point))]))
    assert (found.id, found.type, found.height) == ("h", "building", 7.0)
    assert found.outline.tolist() == [list(corner) for corner in corners]


@pytest.mark.parametrize("side", [-1, 1])
def test_sidewalks_are_outlined_counter_clockwise(maker: Any, side: int) -> None:
    walk = maker.lane(2 * side, type="sidewalk", width=2.0)
    (outline,) = furniture.sidewalks(maker.map([_road(maker, side, walk)]))
    ring = shapely.LinearRing(outline)
    assert ring.is_ccw
    assert shapely.Polygon(ring).area == pytest.approx(100.0)
    assert sorted({abs(round(float(y), 6)) for y in outline[:, 1]}) == [3.5, 5.5]


def test_a_sidewalk_without_width_is_none(maker: Any) -> None:
    walk = maker.lane(-2, type="sidewalk", widths=(Cubic(0.0, 0.0),))
    assert furniture.sidewalks(maker.map([_road(maker, -1, walk)])) == ()


@pytest.mark.parametrize("name", library.shipped_names())
def test_towns_have_paint_and_sidewalks_of_their_maps(name: str) -> None:
    town = library.load(name)
    assert town.markings
    assert town.sidewalks
    low, high = town.bounds[:2] - 10.0, town.bounds[2:] + 10.0
    for marking in town.markings:
        assert np.all((low < marking.points) & (marking.points < high))
