"""What a road can hold, written and read back."""

from dataclasses import replace

import numpy as np
import pytest

from mjdrive.town import opendrive
from mjdrive.town.opendrive.road_map import (
    Connection,
    Junction,
    LaneRecord,
    LaneSection,
    ObjectRecord,
    Road,
    RoadLink,
    RoadMap,
    SignalRecord,
    SignalReference,
)
from mjdrive.town.opendrive.road_shapes import (
    Arc,
    Cubic,
    Line,
    ParamPoly3,
    Piece,
    Poly3,
    RoadMark,
    Shape,
    Spiral,
)

SHAPES = [
    Line(),
    Arc(-0.02),
    Spiral(0.0, 0.03),
    Poly3(0.0, 0.0, 0.004, -1e-5),
    ParamPoly3((0.0, 10.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.5), is_normalized=True),
    ParamPoly3((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 0.01, 1e-4), is_normalized=False),
]


def _road(lanes: tuple[LaneRecord, ...], **fields: object) -> Road:
    values = {
        "id": "1",
        "name": "Only street",
        "length": 10.0,
        "junction": None,
        "pieces": (Piece(0.0, 3.0, -4.0, 0.5, 10.0),),
        "lane_offsets": (),
        "sections": (LaneSection(0.0, lanes),),
    }
    return Road(**(values | fields))  # type: ignore[arg-type]


def _again(road: Road) -> Road:
    road_map = RoadMap("map", {road.id: road})
    return opendrive.parse(opendrive.write(road_map), source="test").roads[road.id]


LANES = (LaneRecord(0, "none"), LaneRecord(-1, "driving", (Cubic(0.0, 3.5),)))


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_every_shape_is_read_back(shape: Shape) -> None:
    road = _road(LANES, pieces=(Piece(0.0, 3.0, -4.0, 0.5, 10.0, shape),))
    assert _again(road) == road


def test_lanes_keep_marks_borders_and_directions() -> None:
    marks = (
        RoadMark("broken", "white", 0.12, start=0.0, dash=3.0, gap=6.0),
        RoadMark("solid", "yellow", 0.15, start=5.0),
    )
    lanes = (
        LaneRecord(2, "driving", borders=(Cubic(0.0, 7.0, 0.01),), direction="reversed"),
        LaneRecord(1, "driving", borders=(Cubic(0.0, 3.5),), direction="both"),
        LaneRecord(0, "none", marks=marks),
        LaneRecord(-1, "driving", (Cubic(0.0, 3.5, 0.1, 0.01, 0.001), Cubic(4.0, 3.7)), -1, -2),
    )
    road = _road(lanes, lane_offsets=(Cubic(0.0, 0.1, 0.2, -0.3, 0.4),))
    assert _again(road) == road


def test_sections_links_and_the_side_of_traffic_are_kept() -> None:
    road = _road(
        LANES, sections=(LaneSection(0.0, LANES), LaneSection(4.0, LANES)), drives_on_left=True
    )
    roads = {
        "1": replace(road, successor=RoadLink("road", "2", "start")),
        "2": replace(road, id="2", predecessor=RoadLink("road", "1", "end")),
    }
    road_map = RoadMap("left", roads)
    assert opendrive.parse(opendrive.write(road_map), source="test") == road_map


def test_signals_and_references_are_kept() -> None:
    sign = SignalRecord(
        "s1", "Limit", "274", 2.5, -4.0, "+", -1, -1, dynamic=False, value=50.0, unit="km/h"
    )
    road = _road(
        LANES, signals=(sign,), references=(SignalReference("s1", -1, -1, s=7.0, orientation="-"),)
    )
    assert _again(road) == road


def test_objects_keep_their_place_and_outline() -> None:
    outline = ((10.0, 2.0), (14.0, 2.5), (13.0, 5.0))
    house = ObjectRecord("7", "House", "building", 4.0, 6.5, 0.3, outline, 8.0)
    tree = ObjectRecord("8", "Tree", "tree", 9.0, -5.0, 0.0, (), 6.0)
    again = _again(
        _road(LANES, pieces=(Piece(0.0, 3.0, -4.0, 0.5, 10.0, Arc(0.05)),), objects=(house, tree))
    )
    found = again.objects[0]
    np.testing.assert_allclose(found.outline, outline, atol=1e-8)
    assert (replace(found, outline=outline), again.objects[1]) == (house, tree)


def test_direct_junctions_stay_direct() -> None:
    link = RoadLink("junction", "9")
    roads = {
        "1": _road(LANES, successor=link),
        "2": _road(LANES, id="2", predecessor=link, pieces=(Piece(0.0, 13.0, -4.0, 0.5, 10.0),)),
    }
    ways = (
        Connection("0", "1", "2", "start", ((-1, -1),)),
        Connection("0_back", "2", "1", "end", ((-1, -1),)),
    )
    road_map = RoadMap("direct", roads, {"9": Junction("9", "Split", ways)})
    document = opendrive.write(road_map)
    assert b'type="direct"' in document
    assert opendrive.parse(document, source="test") == road_map
