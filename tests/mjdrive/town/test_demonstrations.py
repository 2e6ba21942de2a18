from collections import Counter
from typing import Any

import numpy as np
import pytest

from mjdrive.datatypes import Move, Town
from mjdrive.errors import RouteError
from mjdrive.town import library, routing
from mjdrive.town.demonstrations import demonstration_routes
from mjdrive.town.network import build_town
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


def test_a_ring_is_driven_round_and_round(maker: Any) -> None:
    ring = maker.ring("1", 50.0, (0.0, 2.0 * np.pi), links=("1:end", "1:start"))
    town = build_town(maker.map([ring]), name="ring", timing=LightTiming(), digest="")
    rng = np.random.default_rng(0)
    for waypoints in demonstration_routes(town, num_routes=5, length=800.0, rng=rng).values():
        route = routing.route_through(town, np.array(waypoints))
        assert route.station[-1] == pytest.approx(800.0, rel=1 / 6, abs=1.0)
        assert set(route.lanes) == {"1/0/-1"}
        assert len(route.lanes) >= 3


def _street(maker: Any, length: float) -> Town:
    road = maker.road("1", ((0.0, 0.0), (length, 0.0)), maker.section(1, -1))
    return build_town(maker.map([road]), name="street", timing=LightTiming(), digest="")


@pytest.mark.parametrize(("end", "given"), [(700.0, 400.0), (300.0, 200.0)])
def test_a_town_that_ends_soon_has_shorter_routes(maker: Any, end: float, given: float) -> None:
    town = _street(maker, end)
    rng = np.random.default_rng(0)
    routes = demonstration_routes(town, num_routes=3, length=900.0, rng=rng)
    assert len(routes) == 3
    for waypoints in routes.values():
        route = routing.route_through(town, np.array(waypoints))
        assert route.station[-1] == pytest.approx(given, rel=1 / 6, abs=1.0)


def test_a_town_that_ends_too_soon_has_no_routes(maker: Any) -> None:
    with pytest.raises(
        RouteError, match="no route of about 500 m in town 'street', nor one of 200"
    ):
        demonstration_routes(
            _street(maker, 100.0), num_routes=1, length=500.0, rng=np.random.default_rng(0)
        )
