import re

import pytest

from mjdrive.town import opendrive
from mjdrive.town.opendrive.road_shapes import RoadMark

DUST = b'<line length="1e-300" space="1e-9"'
WHITE = b'color="white"'


def _marks(data: bytes) -> list[RoadMark]:
    roads = opendrive.parse(data, source="map").roads.values()
    sections = [section for road in roads for section in road.sections]
    return [mark for section in sections for lane in section.lanes for mark in lane.marks]


@pytest.mark.parametrize("word", ["violet", "Violet", "VIOLET"])
def test_colors_are_known_in_any_case(rich_bytes: bytes, word: str) -> None:
    data = rich_bytes.replace(WHITE, f'color="{word}"'.encode())
    assert data != rich_bytes
    assert "violet" in {mark.color for mark in _marks(data)}
    report = opendrive.parse_with_report(data, source="map")[1]
    assert not [what for what in report.not_used if what.startswith("road mark color")]


def test_unknown_colors_are_white_and_noted(rich_bytes: bytes) -> None:
    data = rich_bytes.replace(WHITE, b'color="Mauve"')
    assert [mark.color for mark in _marks(data)] == [mark.color for mark in _marks(rich_bytes)]
    report = opendrive.parse_with_report(data, source="map")[1]
    assert report.not_used["road mark color 'Mauve'"] == rich_bytes.count(WHITE)


def test_dashes_like_dust_count_as_not_given(rich_bytes: bytes) -> None:
    data, count = re.subn(rb'<line length="[^"]*" space="[^"]*"', DUST, rich_bytes)
    assert count
    assert {(mark.dash, mark.gap) for mark in _marks(data)} == {(0.0, 0.0)}
    report = opendrive.parse_with_report(data, source="map")[1]
    assert report.not_used["road mark with dashes and gaps shorter than 0.1 m"] == count
