import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from mjdrive.datatypes import Route, Town
from mjdrive.errors import RouteError, UnknownNameError
from mjdrive.town import routing
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.random_lanes import random_lanes
from mjdrive.town.random_walk import AHEAD, BEHIND, STRETCH, RandomWalk
from mjdrive.town.settings import LightTiming

FAR = 3000.0


def walk(town: Town, seed: int = 0, *, lane: str | None = None) -> RandomWalk:
    rng = np.random.default_rng(seed)
    start, station = routing.random_start(town, rng)
    return RandomWalk(town, lane=lane or start, station=station, rng=rng, length=100.0)


def windows(town: Town, seed: int, *, every: float = 7.3) -> list[Route]:
    """The windows that a car meets which is looked at every few metres."""
    walking, found = walk(town, seed), []
    for station in np.arange(0.0, FAR, every):
        walking.advance(float(station))
        if not found or walking.route is not found[-1]:
            found.append(walking.route)
    return found


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_windows_are_pieces_of_the_route_that_is_laid_at_once(town02: Town, seed: int) -> None:
    rng = np.random.default_rng(seed)
    lane, station = routing.random_start(town02, rng)
    whole = routing.random_route(town02, lane=lane, station=station, length=FAR + 900.0, rng=rng)
    for window in windows(town02, seed):
        first = int(window.station[0])
        piece = slice(first, first + len(window.station))
        np.testing.assert_allclose(window.points, whole.points[piece], atol=1e-9)
        np.testing.assert_allclose(window.station, whole.station[piece], atol=1e-9)
        names = [window.lanes[index] for index in window.lane_index]
        assert names == [whole.lanes[index] for index in whole.lane_index[piece]]
        inner = slice(first + 1, first + len(window.station) - 1)
        np.testing.assert_allclose(window.curvature[1:-1], whole.curvature[inner], atol=1e-6)


def test_windows_share_points_and_stations_exactly(town02: Town) -> None:
    for before, after in itertools.pairwise(windows(town02, 5)):
        shared = np.isin(after.station, before.station)
        assert shared.sum() >= AHEAD
        again = np.isin(before.station, after.station)
        np.testing.assert_array_equal(after.points[shared], before.points[again])


def test_way_ahead_is_always_known_and_memory_is_bounded(town02: Town) -> None:
    walking = walk(town02, 4)
    longest = max(lane_length(lane) for lane in town02.lanes.values())
    for station in np.arange(0.0, FAR, 0.6):
        walking.advance(float(station))
        assert walking.route.station[-1] >= station + AHEAD
        assert walking.route.station[0] <= max(station - BEHIND, 0.0)
        assert len(walking.route.points) < BEHIND + 2 * AHEAD + STRETCH + longest


def test_same_walk_whatever_the_steps_it_is_asked_in(town02: Town) -> None:
    fine, coarse = windows(town02, 3, every=0.6), windows(town02, 3, every=31.0)
    at = {
        float(s): point
        for route in fine
        for s, point in zip(route.station, route.points, strict=True)
    }
    for route in coarse:
        known = [
            (at[s], point)
            for s, point in zip(route.station.tolist(), route.points, strict=True)
            if s in at
        ]
        assert len(known) > AHEAD
        for ours, theirs in known:
            np.testing.assert_array_equal(ours, theirs)


def test_seeds_take_other_turns(town02: Town) -> None:
    lane = next(name for name, it in town02.lanes.items() if it.junction is None)
    ways = {
        tuple(
            itertools.islice(
                random_lanes(
                    town02, lane=lane, station=0.0, length=math.inf, rng=np.random.default_rng(seed)
                ),
                40,
            )
        )
        for seed in range(20)
    }
    assert len(ways) > 15


def test_every_way_through_every_junction_is_taken_about_equally_often(town02: Town) -> None:
    lane = next(name for name, it in town02.lanes.items() if it.junction is None)
    rng = np.random.default_rng(0)
    names = random_lanes(town02, lane=lane, station=0.0, length=math.inf, rng=rng)
    driven = list(itertools.islice(names, 20_000))
    for approach in (it for it in town02.lanes.values() if len(it.successors) == 2):
        left, right = (driven.count(name) for name in approach.successors)
        assert abs(left - right) < 5 * math.sqrt(left + right)


@pytest.fixture(scope="module")
def dead_end(road_map: RoadMap) -> Town:
    """One street of the ladder, cut off from the others."""
    street = replace(road_map.roads["1"], predecessor=None, successor=None)
    return build_town(
        replace(road_map, roads={"1": street}, junctions={}, controllers={}),
        name="dead end",
        timing=LightTiming(),
        digest="",
    )


def test_walk_ends_at_a_dead_end_and_is_refused_if_that_is_too_soon(dead_end: Town) -> None:
    (name, lane), *_ = dead_end.lanes.items()
    length = lane_length(lane)
    rng = np.random.default_rng(0)
    walking = RandomWalk(dead_end, lane=name, station=5.0, rng=rng, length=length - 6.0)
    walking.advance(length)
    assert walking.route.station[-1] == pytest.approx(length - 5.0, abs=1.0)
    with pytest.raises(RouteError, match=rf"lead on for {length - 5.0:.1f} m; expected"):
        RandomWalk(dead_end, lane=name, station=5.0, rng=rng, length=length)


def test_wrong_starts_are_refused(town02: Town) -> None:
    rng = np.random.default_rng(0)
    with pytest.raises(UnknownNameError, match="Unknown lane 'nowhere'"):
        RandomWalk(town02, lane="nowhere", station=0.0, rng=rng)
    name, lane = next(iter(town02.lanes.items()))
    with pytest.raises(RouteError, match=rf"is not on lane '{name}'"):
        RandomWalk(town02, lane=name, station=lane_length(lane) + 1.0, rng=rng)


def test_a_walk_that_starts_on_a_long_lane_knows_its_way_at_once(town01: Town) -> None:
    name = max(town01.lanes, key=lambda lane: lane_length(town01.lanes[lane]))
    assert lane_length(town01.lanes[name]) > AHEAD
    walking = RandomWalk(town01, lane=name, station=0.0, rng=np.random.default_rng(0))
    assert walking.route.station[-1] >= AHEAD + STRETCH
