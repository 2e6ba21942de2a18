"""What every town keeps, whoever drew it."""

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.datatypes import Move, Signal, Town
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing, signals


@pytest.fixture(scope="module", params=library.shipped_names())
def town(request: pytest.FixtureRequest) -> Town:
    return library.load(request.param)


def test_every_lane_leads_on_and_meets_what_follows(town: Town) -> None:
    for lane in town.lanes.values():
        assert lane.successors
        for name in lane.successors:
            gap = town.lanes[name].centerline[0] - lane.centerline[-1]
            assert np.hypot(*gap) < 0.01


def test_every_approach_leaves_a_choice_of_two_or_three_and_every_light_guards_one(
    town: Town,
) -> None:
    for light in town.lights.values():
        approach = town.lanes[light.lane]
        assert approach.light == light.id
        moves = {town.lanes[name].move for name in approach.successors}
        assert len(moves) == len(approach.successors)
        assert len(moves) in {2, 3}
        assert Move.FOLLOW not in moves
        np.testing.assert_allclose(light.stop_line.mean(axis=0), approach.centerline[-1], atol=0.01)


def test_at_most_one_approach_of_a_junction_may_go(town: Town) -> None:
    junctions = {light.junction for light in town.lights.values()}
    for time in np.arange(0.0, signals.cycle(town), 0.5):
        shown = signals.all_at(town, float(time))
        for junction in junctions:
            going = [
                light
                for light in town.lights.values()
                if light.junction == junction and shown[light.id] is not Signal.RED
            ]
            assert len(going) <= 1


def test_car_stands_still_and_whole_at_any_start(town: Town) -> None:
    simulation = Simulation(town)
    for seed in range(5):
        lane, station = routing.random_start(town, np.random.default_rng(seed))
        simulation.reset(lane=lane, station=station, seed=seed)
        before = simulation.vehicle
        assert simulation.is_on_lane
        assert simulation.step(simulation.action) == ()
        after = simulation.vehicle
        assert np.hypot(after.x - before.x, after.y - before.y) < 1e-3
        bev = simulation.observe().bev
        assert bev[0].any()
        assert not bev[0].all()


def test_every_scene_has_the_parts_that_rules_and_lights_look_for(town: Town) -> None:
    model = Simulation(town).model
    names = [model.geom(index).name for index in range(model.ngeom)]
    for part in ("road", "kerb", "building"):
        assert any(name.split("_")[0] == part for name in names)
    for light in town.lights:
        assert f"pole_{light}" in names
        for colour in ("green", "yellow", "red"):
            assert f"lamp_{light}_{colour}" in names


def test_seeded_starts_are_spread_over_the_town(town: Town) -> None:
    starts = [routing.random_start(town, np.random.default_rng(seed)) for seed in range(60)]
    lanes = {lane for lane, _ in starts}
    assert len(lanes) > 10
    for lane, station in starts:
        assert station <= geometry.stations(town.lanes[lane].centerline)[-1] - 15.0
