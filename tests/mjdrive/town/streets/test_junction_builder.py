from dataclasses import replace
from itertools import permutations

import pytest

from mjdrive.config import from_dict
from mjdrive.town.opendrive.reference_line import curvature_of
from mjdrive.town.streets.junction_builder import build_junction
from mjdrive.town.streets.street_plan import CornerPlan, JunctionPlan, StreetPlan, TurnRadii

ENDS = {"1": (100.0, 0.0), "2": (0.0, 100.0), "3": (-100.0, 0.0), "4": (0.0, -100.0)}


@pytest.fixture(scope="module")
def cross() -> StreetPlan:
    """Four streets from the origin: 1 to the east, 2 north, 3 west, 4 south; where they lead is left out."""
    ends = {road: str(int(road) + 10) for road in ENDS}
    return StreetPlan(
        name="cross",
        nodes={"9": (0.0, 0.0)} | {ends[road]: end for road, end in ENDS.items()},
        streets={road: ("9", end) for road, end in ends.items()},
        corners={end: CornerPlan({road: 10.0, "0": 10.0}, 9.0) for road, end in ends.items()},
        junctions={"9": JunctionPlan(dict.fromkeys(ENDS, 13.0))},
        turn_radii=TurnRadii(left=11.0, right=7.0),
    )


def test_a_way_leads_from_each_street_to_each_other(cross: StreetPlan) -> None:
    crossing = build_junction(cross, "9", first_id=1000)
    (junction,) = crossing.junctions
    links = [(way.predecessor, way.successor) for way in crossing.ways]
    assert [(come.id, go.id) for come, go in links if come and go] == list(permutations(ENDS, 2))
    assert [way.id for way in crossing.ways] == [str(number) for number in range(1000, 1012)]
    assert [link.connecting for link in junction.connections] == [way.id for way in crossing.ways]
    assert junction.controllers == ()


def test_turns_that_are_not_listed_take_the_radii_of_the_plan(cross: StreetPlan) -> None:
    found = sorted(
        round(max((curvature_of(piece) for piece in way.pieces), key=abs), 6)
        for way in build_junction(cross, "9", first_id=1000).ways
    )
    right, left = round(-1.0 / 7.0, 6), round(1.0 / 11.0, 6)
    assert found == [right] * 4 + [0.0] * 4 + [left] * 4


def test_turns_that_are_listed_take_their_own(cross: StreetPlan) -> None:
    values = {"arms": dict.fromkeys(ENDS, 13.0), "turns": [{"come": "1", "go": "2", "radius": 5.0}]}
    own = replace(cross, junctions={"9": from_dict(JunctionPlan, values)})
    way = build_junction(own, "9", first_id=1000).ways[0]
    assert max(abs(curvature_of(piece)) for piece in way.pieces) == pytest.approx(1.0 / 5.0)
