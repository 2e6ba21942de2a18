import re
from pathlib import Path

import pytest

from mjdrive.errors import TownFormatError
from mjdrive.town import opendrive, opendrive_writer
from mjdrive.town.road_map import RoadMap


def test_reading_undoes_writing(road_map: RoadMap, map_bytes: bytes) -> None:
    assert opendrive.parse(map_bytes, source="ladder") == road_map


def test_a_file_is_read_like_its_bytes(tmp_path: Path, road_map: RoadMap, map_bytes: bytes) -> None:
    path = tmp_path / "map.xodr"
    path.write_bytes(map_bytes)
    assert opendrive.read(path) == road_map


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(TownFormatError, match=r"no-such\.xodr.*OpenDRIVE"):
        opendrive.read(tmp_path / "no-such.xodr")


@pytest.mark.parametrize(
    ("data", "complaint"),
    [
        (b"\x00\x01 not xml", "no XML"),
        (b"", "no XML"),
        (b"<html/>", "expected <OpenDRIVE>"),
        (b"<OpenDRIVE/>", "has no <road>"),
        (
            b'<OpenDRIVE><road id="7" junction="-1" length="1"/></OpenDRIVE>',
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
        (
            rb"<line/>",
            b'<spiral curvStart="0" curvEnd="0.1"/>',
            r"road '1'.*<spiral>.*<line> and <arc>",
        ),
        (rb"<line/>", b"", r"road '1'.*nothing"),
        (rb'hdg="[^"]*"', b'hdg="north"', r"hdg='north'; expected a number"),
        (rb'hdg="[^"]*"', b'hdg="nan"', r"hdg='nan'; expected a finite number"),
        (rb'<laneOffset s="0.0"', b"<laneOffset", r"<laneOffset> has no attribute 's'"),
        (rb'<lane id="3"', b'<lane id="4"', r"without a gap"),
        (rb"<width [^>]*>", b"<border/>", r"<border> is not read"),
        (rb'id="2" junction', b'id="1" junction', r"same id"),
        (
            rb"<lanes>",
            b'<elevationProfile><elevation s="0" a="0" b="0.1" c="0" d="0"/></elevationProfile><lanes>',
            r"<elevation> is not 0; mjdrive towns are flat",
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


def test_entities_are_not_expanded(map_bytes: bytes, tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("stolen")
    doctype = (
        f'<!DOCTYPE OpenDRIVE [<!ENTITY e SYSTEM "{secret.as_uri()}">]><OpenDRIVE>&e;'.encode()
    )
    road_map = opendrive.parse(map_bytes.replace(b"<OpenDRIVE>", doctype, 1), source="entity")
    assert b"stolen" not in opendrive_writer.write(road_map)
