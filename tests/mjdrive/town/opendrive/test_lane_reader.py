import re

import numpy as np
import pytest

from mjdrive.errors import TownFormatError
from mjdrive.town import opendrive
from mjdrive.town.opendrive.cross_section import CrossSections, LaneOfRoad
from mjdrive.town.opendrive.road_map import Road, RoadMap
from mjdrive.town.opendrive.road_shapes import Cubic, RoadMark


@pytest.fixture(scope="module")
def rich(rich_bytes: bytes) -> RoadMap:
    return opendrive.parse(rich_bytes, source="rich")


def _ids(road: Road) -> list[list[int]]:
    return [[lane.id for lane in section.lanes] for section in road.sections]


def test_a_section_of_one_side_keeps_the_lanes_of_the_other(rich: RoadMap) -> None:
    road = rich.roads["1"]
    assert _ids(road) == [[2, 1, 0, -1], [2, 1, 0, -1, -2], [2, 1, 0, -1, -2]]
    left = [section.lane(1) for section in road.sections]
    assert [(lane.predecessor, lane.successor) for lane in left if lane] == [
        (None, 1),
        (1, 1),
        (1, None),
    ]


def test_a_lane_that_goes_on_keeps_its_shape(rich_bytes: bytes) -> None:
    wavy = rich_bytes.replace(
        b'<width sOffset="0" a="2" b="0" c="0" d="0"/>\n            <height',
        b'<width sOffset="0" a="2" b="0.01" c="0.002" d="-0.0001"/><width sOffset="30" a="1" b="0.1" c="0" d="0"/>\n'
        b"            <height",
        1,
    )
    assert wavy != rich_bytes
    road = opendrive.parse(wavy, source="wavy").roads["1"]
    for index, (start, end) in enumerate([(0.0, 20.0), (20.0, 40.0), (40.0, 60.0)]):
        s = np.linspace(start, end - 1e-6, 30)
        lane = CrossSections([LaneOfRoad(road, index, 2)])
        inner, outer = lane.edges(np.zeros(len(s), dtype=int), s)
        first = 2.0 + s * (0.01 + s * (0.002 - 0.0001 * s))
        expected = np.where(s < 30.0, first, 1.0 + 0.1 * (s - 30.0))
        np.testing.assert_allclose(outer - inner, np.maximum(expected, 0.0), atol=1e-9)


def test_two_sections_of_one_side_at_one_place_are_one(rich_bytes: bytes) -> None:
    moved = rich_bytes.replace(
        b'<laneSection s="40" singleSide="true">', b'<laneSection s="20" singleSide="true">'
    )
    assert len(opendrive.parse(moved, source="map").roads["1"].sections) == 2


def test_widths_and_borders_are_read(rich: RoadMap) -> None:
    lane = rich.roads["1"].sections[2].lane(-2)
    assert lane is not None
    assert lane.borders == (Cubic(0.0, -5.5), Cubic(10.0, -5.5, 0.01))
    assert lane.widths == ()


def test_widths_count_where_a_lane_has_borders_too(rich_bytes: bytes) -> None:
    both = rich_bytes.replace(
        b'<border sOffset="0" a="-3.5"',
        b'<width sOffset="0" a="3" b="0" c="0" d="0"/><border sOffset="0" a="-3.5"',
    )
    road_map, report = opendrive.parse_with_report(both, source="map")
    lane = road_map.roads["1"].sections[2].lane(-1)
    assert lane is not None
    assert (lane.widths, lane.borders) == ((Cubic(0.0, 3.0),), ())
    assert report.not_used["road/lanes/laneSection/right/lane/border"] == 1


def test_directions_are_read(rich: RoadMap) -> None:
    lanes = rich.roads["7"].sections[0].lanes
    assert [lane.direction for lane in lanes if lane.id] == [
        "standard",
        "standard",
        "reversed",
        "both",
    ]


def test_marks_are_read_with_their_dashes(rich: RoadMap) -> None:
    middle = rich.roads["1"].sections[0].lane(0)
    assert middle is not None
    assert middle.marks == (
        RoadMark("solid solid", "yellow", 0.12),
        RoadMark("broken", "white", 0.15, start=30.0, dash=3.0, gap=6.0),
        RoadMark("solid broken", "white", 0.12, start=50.0, dash=1.5, gap=1.5),
    )


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (
            b'<width sOffset="10" a="2"',
            b'<width sOffset="-1" a="2"',
            "<width> starts at -1, before",
        ),
        (b'<laneOffset s="30"', b'<laneOffset s="5"', "<laneOffset> starts at 5, before"),
        (b'<roadMark sOffset="50"', b'<roadMark sOffset="20"', "<roadMark> starts at 20, before"),
        (b'<laneSection s="30">', b'<laneSection s="0">', "<lanes> has a lane section without len"),
        (b'<laneSection s="30">', b'<laneSection s="98">', "<lanes> has a lane section without le"),
    ],
)
def test_what_is_out_of_order_is_refused(
    rich_bytes: bytes, old: bytes, new: bytes, complaint: str
) -> None:
    assert old in rich_bytes
    with pytest.raises(TownFormatError, match=r"map:\d+, road '\d': " + re.escape(complaint)):
        opendrive.parse(rich_bytes.replace(old, new, 1), source="map")


@pytest.mark.parametrize(
    "width", ['a="1e9" b="0" c="0" d="0"', 'a="3" b="0" c="0" d="7"', 'a="0" b="90" c="-1.5" d="0"']
)
def test_a_lane_wider_than_any_is_refused_with_its_line(map_bytes: bytes, width: str) -> None:
    wide = f'<width sOffset="0" {width}/>'.encode()
    data, count = re.subn(rb"<width [^/]*/>", wide, map_bytes, count=1)
    assert count
    with pytest.raises(
        TownFormatError, match=r"map:\d+, road '\d+': <laneSection> has lane -?\d up"
    ):
        opendrive.parse(data, source="map")


def test_a_width_behind_the_end_of_its_section_says_nothing(map_bytes: bytes) -> None:
    behind = b'<width sOffset="5000" a="1e9" b="0" c="0" d="0"/>'
    data, count = re.subn(rb"(<width [^/]*/>)", rb"\1" + behind, map_bytes, count=1)
    assert count
    opendrive.parse(data, source="map")
