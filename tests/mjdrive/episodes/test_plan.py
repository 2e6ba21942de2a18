import dataclasses

import numpy as np
import pytest

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Route, Town
from mjdrive.episodes.plan import PlannedEpisode, episode_seed, lay_routes, plan
from mjdrive.errors import ConfigError, RouteError, UnknownNameError
from mjdrive.town import library, routing


@pytest.fixture(scope="module")
def routes(town02: Town) -> dict[str, Route]:
    waypoints = library.load_settings("town02").routes
    return {
        name: routing.route_through(town02, np.array(waypoints[name]))
        for name in ("route0", "route2")
    }


def names(episodes: tuple[PlannedEpisode, ...]) -> list[str]:
    return [episode.name for episode in episodes]


def test_every_route_is_driven_once_in_the_order_of_the_town(
    town02: Town, routes: dict[str, Route]
) -> None:
    planned = plan(town02, routes, settings=CollectConfig(), seed=3)
    assert names(planned) == ["route0-0", "route2-0"]
    assert [episode.length for episode in planned] == [
        route.station[-1] for route in routes.values()
    ]
    assert [episode.seed for episode in planned] == [episode_seed(3, 0), episode_seed(3, 1)]


def test_episodes_beyond_the_routes_begin_with_the_first_again(
    town02: Town, routes: dict[str, Route]
) -> None:
    planned = plan(town02, routes, settings=CollectConfig(episodes=5), seed=0)
    assert names(planned) == ["route0-0", "route2-0", "route0-1", "route2-1", "route0-2"]
    assert len({episode.seed for episode in planned}) == 5
    assert planned[:4] == plan(town02, routes, settings=CollectConfig(repeats=2), seed=0)
    assert names(plan(town02, routes, settings=CollectConfig(episodes=1), seed=0)) == ["route0-0"]


@pytest.mark.parametrize(
    ("km", "episodes", "lengths"),
    [
        (2.5, None, [1000.0, 1000.0, 500.0]),
        (0.4, None, [400.0]),
        (1.0, None, [1000.0]),
        (1.03, None, [1030.0]),  # 30 m are no episode
        (2.0, 4, [500.0] * 4),
    ],
)
def test_random_walk_is_cut_into_episodes(
    town02: Town, km: float, episodes: int | None, lengths: list[float]
) -> None:
    settings = CollectConfig(random_walk_km=km, episodes=episodes)
    planned = plan(town02, {}, settings=settings, seed=0)
    assert [episode.length for episode in planned] == pytest.approx(lengths)
    assert names(planned) == [f"walk-{index}" for index in range(len(lengths))]
    assert {episode.route for episode in planned} == {""}


@pytest.mark.parametrize(("km", "episodes"), [(0.01, None), (1.0, 30)])
def test_random_walk_in_pieces_too_short_is_refused(
    town02: Town, km: float, episodes: int | None
) -> None:
    with pytest.raises(ConfigError, match=r"expected 50 m or more"):
        plan(town02, {}, settings=CollectConfig(random_walk_km=km, episodes=episodes), seed=0)


def test_unknown_route_is_refused(town02: Town, routes: dict[str, Route]) -> None:
    with pytest.raises(UnknownNameError, match=r"route of town02 'rout0'.*Did you mean 'route0'"):
        plan(town02, routes, settings=CollectConfig(routes=("rout0",)), seed=0)


def test_town_without_routes_is_refused_unless_it_is_walked(town02: Town) -> None:
    with pytest.raises(RouteError, match=r"'town02' has no routes.*--random-walk KM"):
        plan(town02, {}, settings=CollectConfig(), seed=0)
    assert plan(town02, {}, settings=CollectConfig(random_walk_km=1.0), seed=0)


def test_route_through_a_gap_is_refused_by_its_name(town02: Town) -> None:
    waypoints = library.load_settings("town02").routes["route0"]
    gap = (waypoints[0], (waypoints[0][0] + 500.0, waypoints[0][1]))
    with pytest.raises(RouteError, match=r"Route 'gap' of town02.*Waypoint 1 .* lies on no lane"):
        lay_routes(town02, {"gap": gap}, settings=CollectConfig())


def test_route_that_no_lanes_connect_is_refused_by_its_name(town02: Town) -> None:
    light = next(iter(town02.lights.values()))
    lane = dataclasses.replace(town02.lanes[light.lane], successors=())
    cut = dataclasses.replace(town02, lanes={**town02.lanes, lane.id: lane})
    last = tuple(lane.centerline[len(lane.centerline) // 2].tolist())
    beyond = town02.lanes[town02.lanes[town02.lanes[light.lane].successors[0]].successors[0]]
    places = (last, tuple(beyond.centerline[len(beyond.centerline) // 2].tolist()))
    with pytest.raises(RouteError, match=r"Route 'gap' of town02.*cannot be reached"):
        lay_routes(cut, {"gap": places}, settings=CollectConfig())


def test_only_the_routes_that_are_driven_are_laid(town02: Town) -> None:
    waypoints = {**library.load_settings("town02").routes, "nowhere": ((0.0, 0.0), (9e3, 9e3))}
    assert list(lay_routes(town02, waypoints, settings=CollectConfig(routes=("route2",)))) == [
        "route2"
    ]
    assert lay_routes(town02, waypoints, settings=CollectConfig(random_walk_km=1.0)) == {}


def test_episode_seeds_of_neighbouring_collections_differ() -> None:
    seeds = {episode_seed(seed, index) for seed in range(20) for index in range(20)}
    assert len(seeds) == 400
