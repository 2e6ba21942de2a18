import math
import re

import numpy as np
import pytest
import shapely

from mjdrive.errors import TownFormatError
from mjdrive.town import opendrive
from mjdrive.town.opendrive.road_map import ObjectRecord

Objects = dict[str, ObjectRecord]


@pytest.fixture(scope="module")
def objects(rich_bytes: bytes) -> Objects:
    """The objects of road 1, which runs east from (-60, 0)."""
    road = opendrive.parse(rich_bytes, source="rich").roads["1"]
    return {thing.id: thing for thing in road.objects}


def test_corners_along_the_road_are_in_the_world(objects: Objects) -> None:
    house = objects["o1"]
    assert shapely.Polygon(house.outline).equals(shapely.box(-45.0, 10.0, -35.0, 20.0))
    assert (house.type, house.height) == ("building", 9.0)


def test_corners_of_its_own_frame_turn_with_the_object(objects: Objects) -> None:
    zebra = shapely.Polygon(objects["o2"].outline)
    upright = shapely.affinity.rotate(zebra, -0.1, origin=(-10.0, 0.0), use_radians=True)
    np.testing.assert_allclose(upright.bounds, (-11.5, -3.5, -8.5, 3.5), atol=1e-9)


def test_a_round_object_has_its_radius(objects: Objects) -> None:
    corners = np.array(objects["o3"].outline)
    np.testing.assert_allclose(np.hypot(*(corners - [-50.0, 9.0]).T), 2.0)


def test_an_object_repeats_along_its_road(objects: Objects) -> None:
    rails = [thing for name, thing in objects.items() if name.startswith("o4")]
    assert [thing.id for thing in rails] == [f"o4/0/{number}" for number in range(5)]
    for number, thing in enumerate(rails):
        # Length along the road, width across.
        x = -60.0 + 5.0 * number
        bounds = shapely.Polygon(thing.outline).bounds
        np.testing.assert_allclose(bounds, (x - 2.0, -8.15, x + 2.0, -7.85), atol=1e-9)


def test_an_object_without_gaps_is_one_strip_along_the_bend(rich_bytes: bytes) -> None:
    rail = (
        b'<objects><object id="r" type="barrier" s="0" t="0" width="0.5" height="1">'
        b'<repeat s="0" length="99" distance="0" tStart="2" tEnd="2" widthStart="0.5" widthEnd="0.5"'
        b' heightStart="1" heightEnd="2"/></object></objects>'
    )
    # Road 11 is a quarter circle of 10 m to the right: 2 m to its left the radius is 12 m.
    head, tail = rich_bytes.split(b'<road id="11"')
    data = head + b'<road id="11"' + tail.replace(b"</lanes>", b"</lanes>" + rail, 1)
    (thing,) = opendrive.parse(data, source="bend").roads["11"].objects
    assert thing.height == 2.0
    assert shapely.Polygon(thing.outline).area == pytest.approx(
        np.pi / 4 * (12.25**2 - 11.75**2), rel=2e-3
    )


def test_sizes_change_from_copy_to_copy(rich_bytes: bytes) -> None:
    changed = rich_bytes.replace(
        b'tStart="-8" tEnd="-8"', b'tStart="-8" tEnd="-12" lengthStart="1" lengthEnd="3"'
    )
    road = opendrive.parse(changed, source="map").roads["1"]
    last = next(thing for thing in road.objects if thing.id == "o4/0/4")
    assert (last.s, last.t) == (20.0, -12.0)
    west, _, east, _ = shapely.Polygon(last.outline).bounds
    assert east - west == pytest.approx(3.0)


def test_too_many_copies_are_refused(rich_bytes: bytes) -> None:
    with pytest.raises(TownFormatError, match=r"<repeat> makes \d+ copies; expected at most"):
        opendrive.parse(rich_bytes.replace(b'distance="5"', b'distance="1e-9"'), source="map")


def test_outlines_go_round_counter_clockwise(objects: Objects) -> None:
    for thing in objects.values():
        if thing.outline:
            assert shapely.LinearRing(thing.outline).is_ccw


def test_an_object_without_extent_has_no_outline(objects: Objects) -> None:
    assert objects["o5"].outline == ()


def test_objects_stand_beside_bends(rich_bytes: bytes) -> None:
    box = b'<objects><object id="b" type="pole" s="15.707963268" t="-2" hdg="0.2" length="2" width="1"/></objects>'
    # Road 11 is a quarter circle to the right about (0, -10): at its end it leads south through (10, -10).
    head, tail = rich_bytes.split(b'<road id="11"')
    data = head + b'<road id="11"' + tail.replace(b"</lanes>", b"</lanes>" + box, 1)
    (thing,) = opendrive.parse(data, source="bend").roads["11"].objects
    outline = shapely.Polygon(thing.outline)
    np.testing.assert_allclose(outline.centroid.coords[0], (8.0, -10.0), atol=1e-6)
    along = np.array(thing.outline[0]) - np.array(thing.outline[1])
    assert math.atan2(along[1], along[0]) == pytest.approx(-math.pi / 2 + 0.2, abs=1e-6)
    assert np.hypot(*along) == pytest.approx(2.0)


def test_a_corner_that_is_no_number_is_refused(rich_bytes: bytes) -> None:
    with pytest.raises(TownFormatError, match=r"map:\d+, road '1': <cornerLocal> has u='left'"):
        opendrive.parse(rich_bytes.replace(b'u="-1.5"', b'u="left"'), source="map")


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (b'u="-1.5"', b'u="-1e9"', "covers 9.95004e+08 m of ground; expected at most 1000 m"),
        (b'radius="2"', b'radius="501"', "covers 1002 m of ground; expected at most 1000 m"),
        (b'height="9"', b'height="1001"', "is 1001 m high; expected at most 1000 m"),
        (b'tEnd="-8"', b'tEnd="-8" lengthEnd="1e4"', "m of ground; expected at most 1060 m"),
    ],
)
def test_an_object_larger_than_any_is_refused(
    rich_bytes: bytes, old: bytes, new: bytes, complaint: str
) -> None:
    assert old in rich_bytes
    with pytest.raises(
        TownFormatError, match=r"map:\d+, road '1': <object> .*" + re.escape(complaint)
    ):
        opendrive.parse(rich_bytes.replace(old, new), source="map")
