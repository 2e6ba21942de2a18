from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mjdrive.datatypes import Move, Town
from mjdrive.errors import TownFormatError
from mjdrive.town.links import LaneKey, Links
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.opendrive.road_shapes import Cubic
from mjdrive.town.opendrive.vocabulary import DRIVEN_LANE_TYPES
from mjdrive.town.settings import LightTiming


def _build(road_map: RoadMap) -> Town:
    return build_town(road_map, name="small", timing=LightTiming(), digest="")


def _ends(town: Town, name: str) -> list[list[float]]:
    return np.round(town.lanes[name].centerline[[0, -1]], 6).tolist()


def test_traffic_keeps_left_where_the_road_says_so(maker: Any) -> None:
    both = maker.section(1, -1)
    first = maker.road("1", ((0, 0), (50, 0)), both, links=("", "2:start"), drives_on_left=True)
    second = maker.road("2", ((50, 0), (90, 0)), both, links=("1:end", ""), drives_on_left=True)
    town = _build(maker.map([first, second]))
    assert _ends(town, "1/0/1") == [[0.0, 1.75], [50.0, 1.75]]
    assert _ends(town, "1/0/-1") == [[50.0, -1.75], [0.0, -1.75]]
    assert town.lanes["1/0/1"].successors == ("2/0/1",)
    assert town.lanes["2/0/-1"].successors == ("1/0/-1",)
    assert town.lanes["1/0/-1"].successors == ()


def test_a_reversed_lane_runs_against_the_rule(maker: Any) -> None:
    section = maker.section(maker.lane(1, direction="reversed"), -1)
    town = _build(maker.map([maker.road("1", ((0, 0), (50, 0)), section)]))
    assert _ends(town, "1/0/1") == [[0.0, 1.75], [50.0, 1.75]]
    assert (town.lanes["1/0/1"].left, town.lanes["1/0/1"].right) == (None, "1/0/-1")
    assert (town.lanes["1/0/-1"].left, town.lanes["1/0/-1"].right) == ("1/0/1", None)


def test_neighbours_are_lanes_beside_in_the_same_direction(maker: Any) -> None:
    road = maker.road("1", ((0, 0), (50, 0)), maker.section(2, 1, -1, -2, -3))
    lanes = _build(maker.map([road])).lanes
    beside = {name[4:]: (lane.left, lane.right) for name, lane in lanes.items()}
    assert beside == {
        "2": ("1/0/1", None),
        "1": (None, "1/0/2"),
        "-1": (None, "1/0/-2"),
        "-2": ("1/0/-1", "1/0/-3"),
        "-3": ("1/0/-2", None),
    }
    left = lanes["1/0/1"].centerline[0] - lanes["1/0/2"].centerline[0]
    assert left.tolist() == [0.0, -3.5], "lane 1 heads west, and its neighbour 2 lies north of it"


def test_a_parking_lane_between_two_lanes_parts_them(maker: Any) -> None:
    section = maker.section(-1, maker.lane(-2, type="parking"), -3)
    lanes = _build(maker.map([maker.road("1", ((0, 0), (50, 0)), section)])).lanes
    assert set(lanes) == {"1/0/-1", "1/0/-3"}
    assert lanes["1/0/-1"].right is None
    assert lanes["1/0/-3"].left is None


@pytest.mark.parametrize("kind", sorted(DRIVEN_LANE_TYPES))
def test_each_driven_type_is_a_lane(maker: Any, kind: str) -> None:
    section = maker.section(maker.lane(-1, type=kind))
    assert _build(maker.map([maker.road("1", ((0, 0), (9, 0)), section)])).lanes


def test_a_lane_that_vanishes_tapers_and_leads_nowhere(maker: Any) -> None:
    taper = maker.lane(-2, successor=None, widths=(Cubic(0.0, 3.5), Cubic(20.0, 3.5, -0.35)))
    sections = (maker.section(-1, taper), maker.section(-1, s=30.0))
    lanes = _build(maker.map([maker.road("1", ((0, 0), (50, 0)), *sections)])).lanes
    assert lanes["1/0/-1"].successors == ("1/1/-1",)
    ending = lanes["1/0/-2"]
    assert ending.successors == ()
    assert ending.left == "1/0/-1"
    assert ending.widths is not None
    assert ending.widths[[0, -1]] == pytest.approx([3.5, 0.0])
    assert ending.width == pytest.approx(ending.widths.mean())
    assert ending.centerline[-1] == pytest.approx([30.0, -3.5])


def test_a_lane_of_one_width_needs_no_widths(maker: Any) -> None:
    lane = _build(maker.map([maker.road("1", ((0, 0), (50, 0)), maker.section(-1))])).lanes[
        "1/0/-1"
    ]
    assert lane.widths is None
    assert lane.width == 3.5


def test_a_section_without_length_is_passed_through(maker: Any) -> None:
    sections = [maker.section(-1, s=s) for s in (0.0, 25.0, 25.0)]
    lanes = _build(maker.map([maker.road("1", ((0, 0), (50, 0)), *sections)])).lanes
    assert set(lanes) == {"1/0/-1", "1/2/-1"}
    assert lanes["1/0/-1"].successors == ("1/2/-1",)


def test_roads_that_meet_end_to_end_are_linked_against_their_direction(maker: Any) -> None:
    towards = maker.section(maker.lane(-1, successor=1), maker.lane(1, successor=-1))
    first = maker.road("1", ((0, 0), (50, 0)), towards, links=("", "2:end"))
    second = maker.road("2", ((90, 0), (50, 0)), towards, links=("", "1:end"))
    town = _build(maker.map([first, second]))
    assert town.lanes["1/0/-1"].successors == ("2/0/1",)
    assert town.lanes["2/0/-1"].successors == ("1/0/1",)
    assert _ends(town, "2/0/1") == [[50.0, -1.75], [90.0, -1.75]]


def test_a_link_to_a_lane_of_the_other_direction_is_no_way(maker: Any) -> None:
    first = maker.road(
        "1", ((0, 0), (50, 0)), maker.section(maker.lane(-1, successor=1)), links=("", "2:start")
    )
    second = maker.road("2", ((50, 0), (90, 0)), maker.section(1, -1), links=("1:end", ""))
    assert _build(maker.map([first, second])).lanes["1/0/-1"].successors == ()


def test_a_direct_junction_leads_on_at_once_and_back(maker: Any) -> None:
    """A road that splits into two, whose lanes for the way back join again."""
    main = maker.road("1", ((0, 0), (50, 0)), maker.section(1, -1, -2), links=("", "junction:D"))
    on = maker.road("2", ((50, 0), (99, 0)), maker.section(1, -1), links=("junction:D", ""))
    ramp = maker.road("3", ((50, -3.5), (99, -20)), maker.section(-1), links=("junction:D", ""))
    split = maker.junction(
        "D",
        ("1", "2", "start", (-1, -1), (1, 1)),
        ("1", "3", "start", (-2, -1)),
        ("2", "1", "end", (-1, -1), (1, 1)),
    )
    lanes = _build(maker.map([main, on, ramp], [split])).lanes
    assert lanes["1/0/-1"].successors == ("2/0/-1",)
    assert lanes["1/0/-2"].successors == ("3/0/-1",)
    assert lanes["2/0/1"].successors == ("1/0/1",)
    assert {lane.junction for lane in lanes.values()} == {None}
    assert {lane.move for lane in lanes.values()} == {Move.FOLLOW}


def test_a_roundabout_leads_in_around_and_out(roundabout_map: RoadMap) -> None:
    town = _build(roundabout_map)
    ways = {name: set(lane.successors) for name, lane in town.lanes.items()}
    assert ways["e/0/-1"] == {"e1/0/-1"}
    assert ways["e1/0/-1"] == ways["e3/0/-1"] == {"n/0/-1"}
    assert ways["n/0/-1"] == {"w2/0/-1", "w3/0/-1"}
    assert ways["w2/0/-1"] == {"w/0/1"}
    assert ways["w/0/1"] == set()
    for name, lane in town.lanes.items():
        for following in lane.successors:
            gap = town.lanes[following].centerline[0] - lane.centerline[-1]
            assert np.hypot(*gap) < 1e-9, f"{name} does not meet {following}"


def test_a_turn_all_around_an_island_is_to_the_left(maker: Any) -> None:
    ring = maker.ring("1", 8.0, (0.0, np.deg2rad(270.0)), junction="J")
    lane = _build(maker.map([ring], [maker.junction("J")])).lanes["1/0/-1"]
    assert lane.move is Move.LEFT


def test_before_is_the_inverse_of_following(roundabout_map: RoadMap) -> None:
    links = Links(roundabout_map)
    pairs = {(key, way) for key, ways in links.following.items() for way in ways}
    assert pairs == {(way, key) for key, ways in links.before.items() for way in ways}
    assert pairs
    assert links.junction_behind(LaneKey("e", 0, -1)) == "E"
    assert links.junction_behind(LaneKey("e", 0, 1)) is None


@pytest.mark.parametrize(
    ("link", "complaint"),
    [
        ("9:start", "Road '1' leads to road '9', which the map does not have"),
        ("junction:X", "Road '1' leads to junction 'X', which the map does not have"),
        ("junction:J", "Junction 'J' leads to road '8', which the map does not have"),
    ],
)
def test_links_to_what_is_not_there_are_refused(maker: Any, link: str, complaint: str) -> None:
    road = maker.road("1", ((0, 0), (50, 0)), maker.section(-1), links=("", link))
    road_map = maker.map([road], [maker.junction("J", ("1", "8", "start", (-1, -1)))])
    with pytest.raises(TownFormatError, match=complaint):
        _build(road_map)
    assert _build(replace(road_map, roads={"1": replace(road, successor=None)})).lanes
