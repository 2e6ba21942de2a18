from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from mjdrive.datatypes import Move, Town
from mjdrive.errors import RouteError
from mjdrive.town import library, routing
from mjdrive.town.demonstrations import demonstration_routes
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import LightTiming

LENGTH = 500.0


@pytest.fixture(scope="module")
def town() -> Town:
    return library.load("town02")


@pytest.fixture(scope="module")
def routes(town: Town) -> dict[str, tuple[tuple[float, float], ...]]:
    return demonstration_routes(town, num_routes=4, length=LENGTH, rng=np.random.default_rng(1))


def test_waypoints_give_routes_of_about_the_length(
    town: Town, routes: dict[str, tuple[tuple[float, float], ...]]
) -> None:
    assert list(routes) == ["route0", "route1", "route2", "route3"]
    for waypoints in routes.values():
        assert np.round(waypoints, 1).tolist() == [list(point) for point in waypoints]
        route = routing.route_through(town, np.array(waypoints))
        assert LENGTH * 5 / 6 - 1.0 < route.station[-1] < LENGTH * 7 / 6 + 1.0


def test_routes_spread_over_the_town_and_turn_all_ways_alike(
    town: Town, routes: dict[str, tuple[tuple[float, float], ...]]
) -> None:
    chosen = [routing.route_through(town, np.array(points)).lanes for points in routes.values()]
    moves = Counter(
        town.lanes[name].move
        for lanes in chosen
        for name in lanes
        if town.lanes[name].move is not Move.FOLLOW
    )
    assert len(moves) == 3
    assert min(moves.values()) >= 0.7 * max(moves.values())
    rng = np.random.default_rng(1)
    drawn = set()
    for _ in routes:
        lane, station = routing.random_start(town, rng)
        drawn |= set(
            routing.random_route(town, lane=lane, station=station, length=LENGTH, rng=rng).lanes
        )
    assert len({name for lanes in chosen for name in lanes}) > len(drawn)


def test_the_same_generator_gives_the_same_routes(ladder: Town) -> None:
    first, second = (
        demonstration_routes(ladder, num_routes=2, length=200.0, rng=np.random.default_rng(7))
        for _ in range(2)
    )
    assert first == second


def test_a_town_that_ends_too_soon_has_no_routes(road_map: RoadMap) -> None:
    street = replace(road_map.roads["7"], predecessor=None, successor=None)
    alone = RoadMap("street", {"7": street})
    town = build_town(alone, name="street", timing=LightTiming(), digest="")
    with pytest.raises(RouteError, match="no route of about 500 m in town 'street'"):
        demonstration_routes(town, num_routes=1, length=500.0, rng=np.random.default_rng(0))
