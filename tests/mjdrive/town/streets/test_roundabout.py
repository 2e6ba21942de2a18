from dataclasses import replace

import numpy as np
import pytest

from mjdrive.config import from_dict
from mjdrive.datatypes import Move, Town
from mjdrive.errors import ConfigError, TownFormatError
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import LightTiming
from mjdrive.town.streets.street_builder import build_map
from mjdrive.town.streets.street_plan import RoundaboutPlan, StreetPlan


@pytest.fixture(scope="module")
def ring_plan() -> StreetPlan:
    """A roundabout at the origin; two loops, each from one of its four streets to the next."""
    values = {
        "name": "ring",
        "nodes": {"9": [0, 0], "11": [100, 0], "12": [100, 100], "13": [0, 100]}
        | {"21": [-100, 0], "22": [-100, -100], "23": [0, -100]},
        "streets": {"1": ["9", "11"], "2": ["11", "12"], "3": ["12", "13"], "4": ["13", "9"]}
        | {"5": ["9", "21"], "6": ["21", "22"], "7": ["22", "23"], "8": ["23", "9"]},
        "corners": {
            node: {"arms": {come: 10.0, go: 10.0}, "radius": 9.0}
            for node, come, go in (
                *(("11", "1", "2"), ("12", "2", "3"), ("13", "3", "4")),
                *(("21", "5", "6"), ("22", "6", "7"), ("23", "7", "8")),
            )
        },
        "roundabouts": {"9": {"arms": dict.fromkeys(["1", "4", "5", "8"], 28.0)}},
    }
    return from_dict(StreetPlan, values)


@pytest.fixture(scope="module")
def ring_map(ring_plan: StreetPlan) -> RoadMap:
    return build_map(ring_plan)


@pytest.fixture(scope="module")
def ring_town(ring_map: RoadMap) -> Town:
    return build_town(ring_map, name="ring", timing=LightTiming(), digest="")


def test_lanes_meet_and_none_is_a_dead_end(ring_town: Town) -> None:
    for lane in ring_town.lanes.values():
        assert lane.successors
        for name in lane.successors:
            gap = ring_town.lanes[name].centerline[0] - lane.centerline[-1]
            assert np.hypot(*gap) < 1e-6


def test_the_ring_is_a_circle_driven_counter_clockwise(ring_town: Town) -> None:
    ring = [
        lane
        for lane in ring_town.lanes.values()
        if lane.id.startswith("600") or lane.move is Move.LEFT
    ]
    assert len(ring) == 8
    turned = 0.0
    for lane in ring:
        np.testing.assert_allclose(np.hypot(*lane.centerline.T), 16.0, atol=1e-3)
        bearing = np.unwrap(np.arctan2(lane.centerline[:, 1], lane.centerline[:, 0]))
        assert np.all(np.diff(bearing) > 0.0)
        turned += bearing[-1] - bearing[0]
    assert turned == pytest.approx(2.0 * np.pi)


def test_the_ring_leads_from_each_street_to_all_of_them(ring_town: Town) -> None:
    """Back into the same one too: who drives round once may turn back."""
    exits = {"1/0/-1", "4/0/1", "5/0/-1", "8/0/1"}
    for start in ("1/0/1", "4/0/-1", "5/0/1", "8/0/-1"):
        reached = [start]
        for name in reached:
            if name not in exits:
                found = ring_town.lanes[name].successors
                reached.extend(follower for follower in found if follower not in reached)
        assert exits <= set(reached)


def test_it_has_no_lights(ring_town: Town) -> None:
    assert not ring_town.lights


def test_it_is_read_back_as_it_was_written(ring_map: RoadMap) -> None:
    assert opendrive.parse(opendrive.write(ring_map), source="ring") == ring_map


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"arms": dict.fromkeys(["1", "5", "4", "8"], 28.0)}, "expected them counter-clockwise"),
        ({"radius": 8.0}, "at least 96 degrees apart"),
        ({"arms": dict.fromkeys(["1", "4", "5", "8"], 20.0)}, "'9' at road '1' asks for a radius"),
    ],
)
def test_what_does_not_fit_is_refused(
    ring_plan: StreetPlan, changes: dict[str, object], complaint: str
) -> None:
    ring = replace(ring_plan.roundabouts["9"], **changes)  # type: ignore[arg-type]
    with pytest.raises(TownFormatError, match=complaint):
        build_map(replace(ring_plan, roundabouts={"9": ring}))


def test_a_roundabout_has_two_streets_or_more() -> None:
    with pytest.raises(ConfigError, match=r"arms \['1'\]; expected two or more"):
        RoundaboutPlan(arms={"1": 30.0})
