from itertools import pairwise

import pytest

from mjdrive.datatypes import Town
from mjdrive.town.lane_graph import LaneGraph, Place, lane_length


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
