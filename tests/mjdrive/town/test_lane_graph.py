import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.datatypes import Lane, Town
from mjdrive.town.lane_graph import LaneGraph, Place, lane_length, onward, round_trips
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import LightTiming


def test_ahead_on_the_same_lane_no_lane_is_entered(ladder: Town) -> None:
    assert LaneGraph(ladder).leg(Place("1/0/-1", 5.0), Place("1/0/-1", 12.0)) == (7.0, ())


def test_the_length_of_a_leg_is_that_of_its_lanes(ladder: Town) -> None:
    leg = LaneGraph(ladder).leg(Place("1/0/-1", 5.0), Place("3/0/-1", 20.0))
    assert leg is not None
    between = sum(lane_length(ladder.lanes[name]) for name in leg.entered[:-1])
    assert leg.length == pytest.approx(lane_length(ladder.lanes["1/0/-1"]) - 5.0 + between + 20.0)
    chain = ("1/0/-1", *leg.entered)
    assert all(second in ladder.lanes[first].successors for first, second in pairwise(chain))


def test_no_way_is_longer_than_one_over_a_third_place(ladder: Town) -> None:
    graph = LaneGraph(ladder)
    names = sorted(ladder.lanes)[::5]
    legs = {(a, b): graph.leg(Place(a, 1.0), Place(b, 1.0)) for a in names for b in names}
    lengths = {pair: leg.length for pair, leg in legs.items() if leg is not None}
    assert len(lengths) == len(names) ** 2, "every lane can be reached from every lane"
    for a in names:
        for b in names:
            for c in names:
                assert lengths[a, c] <= lengths[a, b] + lengths[b, c] + 1e-9


def test_length_of_a_lane(ladder: Town) -> None:
    assert lane_length(ladder.lanes["1/0/-1"]) == pytest.approx(38.0)


def test_where_lanes_lead_round_one_can_go_on_forever(ladder: Town) -> None:
    assert set(onward(ladder).values()) == {math.inf}


def test_towards_a_dead_end_the_longest_way_counts(roundabout_map: RoadMap) -> None:
    town = build_town(roundabout_map, name="small", timing=LightTiming(), digest="")
    ahead = onward(town)
    assert ahead["w/0/1"] == 0.0
    assert ahead["w2/0/-1"] == pytest.approx(40.0)
    assert ahead["e/0/-1"] == ahead["n/0/-1"] == math.inf


def test_a_round_trip_is_a_set_of_lanes_that_lead_to_each_other(roundabout_map: RoadMap) -> None:
    town = build_town(roundabout_map, name="small", timing=LightTiming(), digest="")
    (ring,) = round_trips(town)
    assert set(ring) == {"n/0/-1", "w3/0/-1", "s/0/-1", "e3/0/-1"}


def test_every_lane_of_a_closed_town_is_on_one_round_trip(ladder: Town) -> None:
    assert round_trips(ladder) == [list(ladder.lanes)]


@given(ways=st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=16))
def test_round_trips_are_found_by_a_slower_way_too(ways: list[tuple[int, int]]) -> None:
    lanes = {
        str(name): Lane(
            id=str(name),
            centerline=np.array([[0.0, name], [1.0, name]]),
            width=3.5,
            successors=tuple(dict.fromkeys(str(b) for a, b in ways if a == name)),
            junction=None,
            light=None,
        )
        for name in range(8)
    }
    town = Town(name="", lanes=lanes, lights={}, bounds=np.zeros(4), digest="")
    reach = np.zeros((8, 8), dtype=bool)
    for a, b in ways:
        reach[a, b] = True
    for _ in range(3):
        reach |= (reach.astype(int) @ reach.astype(int)) > 0
    expected = {
        frozenset(str(b) for b in range(8) if reach[a, b] and reach[b, a])
        for a in range(8)
        if reach[a, a]
    }
    assert {frozenset(part) for part in round_trips(town)} == expected
    endless = {str(a) for a in range(8) if any(reach[a, b] and reach[b, b] for b in range(8))}
    assert {name for name, length in onward(town).items() if math.isinf(length)} == endless


def test_legs_are_the_same_in_any_order_of_asking(ladder: Town) -> None:
    lanes = list(ladder.lanes)
    ends = [Place(name, 1.0) for name in lanes]
    graph, other = LaneGraph(ladder), LaneGraph(ladder)
    for start in lanes[:6]:
        there = [graph.leg(Place(start, 2.0), end) for end in ends]
        back = [other.leg(Place(start, 2.0), end) for end in reversed(ends)]
        assert there == back[::-1]
