from dataclasses import replace
from pathlib import Path

import numpy as np
from lxml import etree

from mjdrive.town import opendrive
from mjdrive.town.opendrive.road_map import RoadMap, SignalReference
from mjdrive.town.opendrive.road_shapes import Cubic


def test_the_same_map_gives_the_same_bytes(road_map: RoadMap, map_bytes: bytes) -> None:
    assert opendrive.write(road_map) == map_bytes


def test_the_header_bounds_every_lane(map_bytes: bytes) -> None:
    header = etree.fromstring(map_bytes).find("header").attrib
    # Sidewalk centres lie 4 + 0.3 + 2 m beside the middle of the outer streets.
    assert [float(header[side]) for side in ("west", "south", "east", "north")] == [
        -6.3,
        -6.3,
        126.3,
        86.3,
    ]
    assert (header["revMajor"], header["revMinor"]) == ("1", "8")


def test_what_the_street_builder_leaves_out_is_written_too(road_map: RoadMap) -> None:
    road = replace(
        road_map.roads["1"],
        references=(SignalReference("712", -1, -1),),
        lane_offsets=(Cubic(0.0, 0.0), Cubic(5.0, 0.1, 0.2, -0.3, 0.4)),
    )
    changed = replace(road_map, roads={**road_map.roads, "1": road})
    assert opendrive.parse(opendrive.write(changed), source="ladder") == changed


def test_a_map_with_a_bit_of_everything_is_read_back() -> None:
    rich = opendrive.read(Path(__file__).parents[1] / "rich.xodr")
    again = opendrive.parse(opendrive.write(rich), source="again")
    for name, road in rich.roads.items():
        for thing, found in zip(road.objects, again.roads[name].objects, strict=True):
            np.testing.assert_allclose(found.outline, thing.outline, atol=1e-8)
    assert _without_outlines(again) == _without_outlines(rich)


def _without_outlines(road_map: RoadMap) -> RoadMap:
    """Corners of objects go through the frame of the object and back: they lose their last digits."""
    roads = {
        name: replace(road, objects=tuple(replace(thing, outline=()) for thing in road.objects))
        for name, road in road_map.roads.items()
    }
    return replace(road_map, roads=roads)
