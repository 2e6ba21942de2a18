from dataclasses import replace
from typing import Any

import pytest

from mjdrive.town.links import LaneKey, Links
from mjdrive.town.opendrive.road_map import RoadMap, SignalRecord, SignalReference
from mjdrive.town.stopped_lanes import stopped_lanes

LENGTH = 200.0
"""Of the street between the junctions A and B of `street` [m]."""


@pytest.fixture
def street(maker: Any) -> RoadMap:
    """A street "1" of one lane each way between junctions A, at its start, and B, at its end."""
    both = maker.section(1, -1)
    roads = [
        maker.road("1", ((0, 0), (LENGTH, 0)), both, links=("junction:A", "junction:B")),
        maker.road("a", ((-20, 0), (0, 0)), both, links=("", "1:start"), junction="A"),
        maker.road("b", ((LENGTH, 0), (220, 0)), both, links=("1:end", ""), junction="B"),
    ]
    junctions = [
        maker.junction("A", ("1", "a", "end", (1, 1))),
        maker.junction("B", ("1", "b", "start", (-1, -1))),
    ]
    return maker.map(roads, junctions)


def _stopped(road_map: RoadMap) -> dict[str, str]:
    """Lanes that the signal "s" stops, and the junctions behind them."""
    found = stopped_lanes(road_map, Links(road_map), {"s"})
    return {key.name: junction for key, junction in found.get("s", {}).items()}


def _with_signal(road_map: RoadMap, s: float, lanes: tuple[int, int], orientation: str) -> RoadMap:
    signal = SignalRecord("s", "", "1000001", s, -5.0, orientation, lanes[0], lanes[1])
    road = replace(road_map.roads["1"], signals=(signal,))
    return replace(road_map, roads={**road_map.roads, "1": road})


@pytest.mark.parametrize(
    ("s", "lanes", "orientation", "expected"),
    [
        (195.0, (-1, -1), "+", {"1/0/-1": "B"}),
        (195.0, (-1, -1), "-", {"1/0/-1": "B"}),  # CARLA turns orientations round
        (5.0, (1, 1), "-", {"1/0/1": "A"}),
        (195.0, (0, 0), "+", {"1/0/-1": "B"}),
        (5.0, (0, 0), "-", {"1/0/1": "A"}),
        (195.0, (-1, 1), "+", {"1/0/-1": "B"}),
        (195.0, (0, 0), "none", {"1/0/-1": "B"}),
        (195.0, (0, 0), "-", {}),  # the lane of that direction ends 195 m further on
        (100.0, (-1, -1), "+", {}),  # a crossing half way
        (151.0, (-1, -1), "+", {"1/0/-1": "B"}),
        (149.0, (-1, -1), "+", {}),
        (195.0, (-2, -2), "+", {}),
    ],
)
def test_a_signal_stops_the_lanes_that_end_behind_it(
    street: RoadMap,
    s: float,
    lanes: tuple[int, int],
    orientation: str,
    expected: dict[str, str],
) -> None:
    assert _stopped(_with_signal(street, s, lanes, orientation)) == expected


def test_where_lanes_are_named_the_others_are_free(street: RoadMap) -> None:
    """The signal names no lane where it stands, and one where it is referred to."""
    road_map = _with_signal(street, 5.0, (0, 0), "-")
    across = replace(road_map.roads["b"], references=(SignalReference("s", -1, -1),))
    assert _stopped(replace(road_map, roads={**road_map.roads, "b": across})) == {"1/0/-1": "B"}


def test_a_lane_that_leads_into_no_junction_is_not_stopped(maker: Any) -> None:
    signal = SignalRecord("s", "", "1000001", 45.0, -5.0, "+", -1, -1)
    roads = [
        maker.road(
            "1", ((0, 0), (50, 0)), maker.section(-1), links=("", "2:start"), signals=(signal,)
        ),
        maker.road("2", ((50, 0), (90, 0)), maker.section(-1), links=("1:end", "")),
    ]
    assert _stopped(maker.map(roads)) == {}


def test_lanes_are_followed_through_the_sections_of_their_road(street: RoadMap, maker: Any) -> None:
    road = replace(
        street.roads["1"],
        sections=(
            maker.section(1, -1),
            maker.section(1, -1, s=10.0),
            maker.section(1, -1, s=190.0),
        ),
    )
    divided = replace(street, roads={**street.roads, "1": road})
    assert _stopped(_with_signal(divided, 170.0, (-1, -1), "+")) == {"1/2/-1": "B"}
    assert _stopped(_with_signal(divided, 30.0, (1, 1), "-")) == {"1/0/1": "A"}


def test_a_ring_without_an_end_is_followed_once(maker: Any) -> None:
    signal = SignalRecord("s", "", "1000001", 1.0, -5.0, "+", -1, -1)
    ring = maker.ring("1", 8.0, (0.0, 6.28), links=("1:end", "1:start"), signals=(signal,))
    assert Links(maker.map([ring])).following == {LaneKey("1", 0, -1): [LaneKey("1", 0, -1)]}
    assert _stopped(maker.map([ring])) == {}
