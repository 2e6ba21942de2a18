"""Towns out of a seed keep what authored towns keep, whatever the seed."""

import json
from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mjdrive.config import from_dict, to_json
from mjdrive.datatypes import Town
from mjdrive.episodes.driving import drive_expert
from mjdrive.errors import ConfigError
from mjdrive.geometry import curvatures
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.settings import LightTiming, TownSettings
from mjdrive.town.streets.generator import MOST_JUNCTIONS, generate_plan
from mjdrive.town.streets.street_builder import build_map
from mjdrive.town.streets.street_plan import StreetPlan

CAR_RADIUS = 3.9
"""Of the rear axle at full lock [m]."""

PLANS = [
    generate_plan(name="g", num_junctions=num_junctions, seed=seed)
    for num_junctions, seed in ((1, 0), (2, 1), (3, 2), (4, 3), (6, 4), (9, 5), (14, 6))
]


def _town(plan: StreetPlan) -> Town:
    return build_town(build_map(plan), name=plan.name, timing=LightTiming(), digest="")


def _reachable(following: dict[str, tuple[str, ...]], start: str) -> set[str]:
    reached = [start]
    for name in reached:
        reached.extend(set(following[name]) - set(reached))
    return set(reached)


@settings(max_examples=15)
@given(num_junctions=st.integers(1, MOST_JUNCTIONS), seed=st.integers(0, 2**32))
def test_there_are_exactly_as_many_junctions_as_asked_for(num_junctions: int, seed: int) -> None:
    plan = generate_plan(name="g", num_junctions=num_junctions, seed=seed)
    assert len(plan.junctions) == num_junctions
    for junction in plan.junctions.values():
        assert len(junction.arms) in {3, 4}
        assert {light.road for light in junction.lights} == set(junction.arms)


@pytest.mark.parametrize("num_junctions", [0, -1, MOST_JUNCTIONS + 1])
def test_towns_that_cannot_be_are_refused(num_junctions: int) -> None:
    with pytest.raises(ConfigError, match=f"num_junctions is {num_junctions}; expected 1 to"):
        generate_plan(name="g", num_junctions=num_junctions, seed=0)


def test_a_negative_seed_is_refused() -> None:
    with pytest.raises(ConfigError, match="seed is -1"):
        generate_plan(name="g", num_junctions=4, seed=-1)


@pytest.fixture(scope="module", params=PLANS, ids=lambda plan: f"{len(plan.junctions)}")
def plan(request: pytest.FixtureRequest) -> StreetPlan:
    return request.param


@pytest.fixture(scope="module")
def town(plan: StreetPlan) -> Town:
    return _town(plan)


def test_every_lane_leads_to_every_other(town: Town) -> None:
    following = {name: lane.successors for name, lane in town.lanes.items()}
    before: dict[str, tuple[str, ...]] = dict.fromkeys(following, ())
    for name, successors in following.items():
        for successor in successors:
            before[successor] += (name,)
    start = next(iter(following))
    assert _reachable(following, start) == _reachable(before, start) == set(town.lanes)


def test_lanes_meet_and_bend_no_more_than_the_car_can(town: Town) -> None:
    for lane in town.lanes.values():
        for successor in lane.successors:
            gap = town.lanes[successor].centerline[0] - lane.centerline[-1]
            assert np.hypot(*gap) < 1e-3
        assert np.abs(curvatures(lane.centerline)).max() < 1.0 / CAR_RADIUS


def test_streets_keep_clear_of_each_other_and_of_the_poles(plan: StreetPlan, town: Town) -> None:
    roads = {
        road: shapely.LineString(town.lanes[f"{road}/0/-1"].centerline).buffer(
            2.0, cap_style="flat"
        )
        for road in [*plan.streets, *plan.corners]
    }
    ends = {road: set(plan.streets.get(road, (road,))) for road in roads}
    for here, there in combinations(sorted(roads), 2):
        if not ends[here] & ends[there]:
            assert roads[here].distance(roads[there]) > 10.0
    lanes = shapely.union_all(
        [shapely.LineString(lane.centerline).buffer(2.0) for lane in town.lanes.values()]
    )
    for light in town.lights.values():
        assert lanes.distance(shapely.Point(light.pole)) > 0.3
        assert np.hypot(*(light.pole - light.stop_line[1])) < 1.0


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others() -> None:
    first, again, other = (
        opendrive.write(build_map(generate_plan(name="g", num_junctions=9, seed=seed)))
        for seed in (4, 4, 5)
    )
    assert first == again != other


def test_a_generated_map_is_read_back_unchanged() -> None:
    road_map = build_map(generate_plan(name="g", num_junctions=7, seed=1))
    assert opendrive.parse(opendrive.write(road_map), source="g") == road_map


def test_a_generated_plan_can_be_written_down_and_read() -> None:
    plan = generate_plan(name="g", num_junctions=5, seed=2)
    values = json.loads(to_json(plan))
    assert from_dict(StreetPlan, values) == plan


def test_the_expert_drives_a_generated_town_without_infraction() -> None:
    town = _town(generate_plan(name="g", num_junctions=6, seed=3))
    episode = drive_expert(Simulation(town, settings=TownSettings()), num_steps=300, seed=0)
    assert episode.infractions == ()
    assert episode.on_lane.all()
