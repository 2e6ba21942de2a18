import re
from dataclasses import replace
from pathlib import Path

import pytest

from mjdrive.errors import TownFormatError
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import ObjectRecord, RoadMap
from mjdrive.town.settings import LightTiming

HEADER = b'<header revMajor="1" revMinor="4"/>'


def test_reading_undoes_writing(road_map: RoadMap, map_bytes: bytes) -> None:
    assert opendrive.parse(map_bytes, source="ladder") == road_map


def test_reading_undoes_writing_of_all_that_is_read(rich_bytes: bytes) -> None:
    road_map = opendrive.parse(rich_bytes, source="rich")
    again = opendrive.parse(opendrive.write(road_map), source="again")
    assert (again.junctions, again.controllers) == (road_map.junctions, road_map.controllers)
    for road, other in zip(road_map.roads.values(), again.roads.values(), strict=True):
        assert replace(road, objects=()) == replace(other, objects=())
        assert [_rounded(thing) for thing in road.objects] == [
            _rounded(thing) for thing in other.objects
        ]


def _rounded(thing: ObjectRecord) -> ObjectRecord:
    """The object with its outline to a micrometre, as the writer rounds what it computes."""
    return replace(thing, outline=tuple((round(x, 6), round(y, 6)) for x, y in thing.outline))


def test_a_file_is_read_like_its_bytes(tmp_path: Path, road_map: RoadMap, map_bytes: bytes) -> None:
    path = tmp_path / "map.xodr"
    path.write_bytes(map_bytes)
    assert opendrive.read(path) == road_map
    assert opendrive.read_with_report(path)[1].source == str(path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(TownFormatError, match=r"no-such\.xodr.*OpenDRIVE"):
        opendrive.read(tmp_path / "no-such.xodr")


@pytest.mark.parametrize(
    ("data", "complaint"),
    [
        (b"\x00\x01 not xml", "no XML"),
        (b"", "no XML"),
        (b"<OpenDRIVE><header>", "no XML.*line 1"),
        (b"<html/>", "bad.xodr:1: .*<html>; expected <OpenDRIVE>"),
        (b"<OpenDRIVE/>", "bad.xodr:1: .*no <header>.*expected OpenDRIVE 1.4 to 1.8"),
        (b"<OpenDRIVE>\n<header revMajor='2' revMinor='0'/></OpenDRIVE>", ":2: .*revMajor='2'"),
        (b"<OpenDRIVE>\n<header/></OpenDRIVE>", ":2: <header> has revMajor='None'"),
        (b"<OpenDRIVE>" + HEADER + b"</OpenDRIVE>", "has no road"),
        (
            b"<OpenDRIVE>" + HEADER + b'<road id="7" junction="-1" length="1"/></OpenDRIVE>',
            "road '7'.*planView/geometry",
        ),
    ],
)
def test_what_is_no_map_is_refused(data: bytes, complaint: str) -> None:
    with pytest.raises(TownFormatError, match=complaint):
        opendrive.parse(data, source="bad.xodr")


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (rb"<line/>", b"", r"road '1'.*<geometry> holds nothing; expected one of <line>, <arc>"),
        (rb"<line/>", b"<line/><arc/>", r"road '1'.*holds <line>, <arc>; expected one"),
        (rb'hdg="[^"]*"', b'hdg="north"', r"<geometry> has hdg='north'; expected a number"),
        (rb'hdg="[^"]*"', b'hdg="nan"', r"hdg='nan'; expected a finite number"),
        (rb'hdg="[^"]*"', b'hdg="1e99"', r"hdg='1e99'; expected at most 1e\+09"),
        (rb'(<road .*)length="[^"]*"', rb'\1length="0"', r"<road> has length='0'; expected more"),
        (rb'(<geometry .*)length="[^"]*"', rb'\1length="0"', r"<geometry> has length='0'"),
        (rb'(<geometry .*)length="[^"]*"', rb'\1length="1"', r"its geometry ends at 1; expected"),
        (rb'<geometry s="0.0"', b'<geometry s="0.5"', r"starts at s=0.5; expected 0, without"),
        (
            rb"<line/>",
            b'<arc curvature="1e8"/>',
            r"<arc> turns by up to .* rad; expected at most 1000",
        ),
        (rb"<line/>", b'<paramPoly3 pRange="x"/>', r"<paramPoly3> has no attribute 'aU'"),
        (rb'<laneOffset s="0.0"', b"<laneOffset", r"<laneOffset> has no attribute 's'"),
        (rb'<lane id="3"', b'<lane id="4"', r"<laneSection> has lanes 4, 2, 1.*without a gap"),
        (rb'<lane id="3"', b'<lane id="-3"', r"<lane> has id='-3'; expected positive on the left"),
        (rb'<lane id="3"', b'<lane id="x"', r"<lane> has id='x'; expected a whole number"),
        (rb"<width [^>]*>", b"", r"<lane> has no <width> and no <border>"),
        (rb'(<width .*)a="[^"]*"', rb'\1a="NaN"', r"<width> has a='NaN'; expected a finite number"),
        (rb'<laneSection s="0.0"', b'<laneSection s="1"', r"<laneSection> starts at s=1; expected"),
        (rb'rule="RHT"', b'rule="up"', r"rule='up'; expected RHT or LHT"),
        (rb'id="2" junction', b'id="1" junction', r"<road> has id='1', as the one in line"),
        (
            rb'<junction id="20"',
            b'<junction id="21"',
            r"<junction> has id='21', as the one in line",
        ),
        (rb'<junction id="20"', b'<junction id="99"', r"junction '20', which the map does not"),
        (rb'elementType="road"', b'elementType="rail"', r"elementType='rail'; expected road or"),
        (rb'contactPoint="(start|end)"', b'contactPoint="side"', r"='side'; expected start or end"),
        (rb'elementId="[^"]*"', b'elementId="77"', r"leads to .* '77', which the map does not"),
        (rb'connectingRoad="[^"]*"', b'connectingRoad="77"', r"connectingRoad='77', which is no"),
        (
            rb'orientation="[+]"',
            b'orientation="up"',
            r"<signal> has orientation='up'; expected \+ or - or none",
        ),
    ],
)
def test_a_defect_is_named_with_its_place(
    map_bytes: bytes, old: bytes, new: bytes, complaint: str
) -> None:
    broken = re.sub(old, new, map_bytes, count=1)
    assert broken != map_bytes
    with pytest.raises(TownFormatError, match=rf"bad\.xodr:\d+.*{complaint}"):
        opendrive.parse(broken, source="bad.xodr")


def test_traffic_may_keep_to_the_left(rich_bytes: bytes) -> None:
    roads = opendrive.parse(rich_bytes, source="rich").roads
    assert [id for id, road in roads.items() if road.drives_on_left] == ["7"]


def test_the_rich_map_is_a_town(rich_bytes: bytes) -> None:
    road_map = opendrive.parse(rich_bytes, source="rich")
    town = build_town(road_map, name="rich", timing=LightTiming(), digest="")
    assert sorted(town.lights) == ["501", "504", "505"]
    assert town.lanes["1/2/-1"].successors == ("10/0/-1", "11/0/-1")
    assert town.lanes["3/0/-1"].successors == ("4/0/-1", "5/0/-1")
