import pytest

from mjdrive.town import opendrive
from mjdrive.town.opendrive.road_map import RoadMap, SignalRecord


@pytest.fixture(scope="module")
def rich(rich_bytes: bytes) -> RoadMap:
    return opendrive.parse(rich_bytes, source="rich")


def _signal(road_map: RoadMap, name: str) -> SignalRecord:
    return next(s for road in road_map.roads.values() for s in road.signals if s.id == name)


def test_signals_are_read(rich: RoadMap) -> None:
    assert _signal(rich, "502") == SignalRecord(
        "502", "Limit", "274", 5.0, -6.0, "+", -1, -1, dynamic=False, value=50.0, unit="km/h"
    )


def test_an_empty_value_is_none(rich: RoadMap) -> None:
    assert _signal(rich, "503").value == -1.0


@pytest.mark.parametrize(
    ("rule", "orientation", "lanes"),
    [
        (b"RHT", b"+", (-2, -1)),
        (b"RHT", b"-", (1, 2)),
        (b"LHT", b"+", (1, 2)),
        (b"LHT", b"-", (-2, -1)),
        (b"RHT", b"none", (-2, 2)),
    ],
)
def test_without_validity_a_signal_holds_for_all_lanes_of_its_direction(
    rich_bytes: bytes, rule: bytes, orientation: bytes, lanes: tuple[int, int]
) -> None:
    changed = rich_bytes.replace(b'rule="RHT"', b'rule="%s"' % rule).replace(
        b'zOffset="5" orientation="+"', b'orientation="%s"' % orientation
    )
    signal = _signal(opendrive.parse(changed, source="map"), "501")
    assert (signal.from_lane, signal.to_lane) == lanes


def test_a_signal_for_lane_0_stops_no_lane_of_its_own_road(rich: RoadMap) -> None:
    signal = _signal(rich, "505")
    assert (signal.from_lane, signal.to_lane) == (0, 0)


def test_references_are_read(rich: RoadMap) -> None:
    (reference,) = rich.roads["12"].references
    assert (reference.id, reference.from_lane, reference.to_lane) == ("505", -1, -1)
    assert (reference.s, reference.orientation) == (0.0, "+")


@pytest.mark.parametrize(
    ("validity", "lanes", "note"),
    [
        (b'fromLane="1" toLane="-1"', (-1, 1), None),
        (b'fromLane="-1000000000" toLane="-1"', (-2, -1), None),
        (b'fromLane="5" toLane="7"', (0, 0), "validity for lanes that the road does not have"),
        (
            b'fromLane="-2" toLane="-2"/><validity fromLane="1" toLane="1"',
            (-2, 1),
            "validity with lanes left out; those between count as well",
        ),
    ],
)
def test_validity_holds_for_lanes_that_the_road_has(
    rich_bytes: bytes, validity: bytes, lanes: tuple[int, int], note: str | None
) -> None:
    changed = rich_bytes.replace(b'fromLane="-1" toLane="-1"', validity, 1)
    road_map, report = opendrive.parse_with_report(changed, source="map")
    signal = _signal(road_map, "503")
    assert (signal.from_lane, signal.to_lane) == lanes
    assert note is None or report.not_used[note] == 1


def test_a_signal_beyond_the_end_of_its_road_is_moved_to_the_end(rich_bytes: bytes) -> None:
    changed = rich_bytes.replace(b's="58" t="-6"', b's="75" t="-6"')
    road_map, report = opendrive.parse_with_report(changed, source="map")
    assert _signal(road_map, "501").s == 60.0
    assert report.not_used["signal beyond the end of its road; moved to the end"] == 1


def test_controllers_name_each_signal_once(rich: RoadMap) -> None:
    assert rich.controllers == {"600": ("501", "504"), "601": ("505",)}


def test_a_reference_to_no_signal_is_reported(rich_bytes: bytes) -> None:
    changed = rich_bytes.replace(b'<signalReference id="505"', b'<signalReference id="x"')
    not_used = opendrive.parse_with_report(changed, source="map")[1].not_used
    assert not_used["signalReference to a signal that the map does not have"] == 2
