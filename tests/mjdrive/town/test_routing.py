from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.datatypes import Move, Route, Town
from mjdrive.errors import RouteError, UnknownNameError
from mjdrive.geometry import headings, stations
from mjdrive.town import library, routing
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import LightTiming

# Length [m] and moves of the published routes, driven on CARLA's own maps.
PUBLISHED = {
    ("town01", "route0"): (762, "LLR"),
    ("town01", "route1"): (565, "SRRR"),
    ("town01", "route2"): (971, "SS"),
    ("town01", "route3"): (1071, "RRRLLSSSR"),
    ("town01", "route4"): (568, "SRRLSL"),
    ("town01", "route5"): (1188, "LSLRRL"),
    ("town01", "route6"): (774, "RLLRR"),
    ("town01", "route7"): (711, "RSS"),
    ("town01", "route8"): (579, "RSRR"),
    ("town01", "route9"): (925, "SLRRS"),
    ("town02", "route0"): (1014, "RSLLSRS"),
    ("town02", "route1"): (1043, "RRRSRSSS"),
    ("town02", "route2"): (919, "LRSLSLLL"),
    ("town02", "route3"): (1002, "RSSLSLS"),
    ("town02", "route4"): (876, "LRLLRRRRLLSR"),
}

# The published sixth route of town02 is its fifth again; ours drives most of what the five leave out.
OURS = {("town02", "route5"): (1064, "RSRLLSSLSLR")}


@pytest.mark.parametrize(("name", "route_name"), PUBLISHED | OURS)
def test_published_routes_have_their_published_length_and_moves(name: str, route_name: str) -> None:
    town = library.load(name)
    waypoints = np.array(library.load_settings(name).routes[route_name])
    route = routing.route_through(town, waypoints)
    length, moves = (PUBLISHED | OURS)[name, route_name]
    assert route.station[-1] == pytest.approx(length, abs=1.5)
    lanes = [town.lanes[lane] for lane in route.lanes]
    assert "".join(lane.move.name[0] for lane in lanes if lane.move != Move.FOLLOW) == moves
    for waypoint in waypoints:
        assert np.min(np.hypot(*(route.points - waypoint).T)) < 2.1


@pytest.mark.parametrize("name", ["town01", "town02"])
def test_towns_have_the_published_routes_and_ours(name: str) -> None:
    routes = {(name, route_name) for route_name in library.load_settings(name).routes}
    assert routes == {pair for pair in PUBLISHED | OURS if pair[0] == name}


def test_the_six_routes_of_town02_take_most_ways_through_its_junctions(town02: Town) -> None:
    waypoints = library.load_settings("town02").routes
    driven = {
        lane
        for points in waypoints.values()
        for lane in routing.route_through(town02, np.array(points)).lanes
    }
    ways = {name for name, lane in town02.lanes.items() if lane.junction is not None}
    assert len(ways) == 48
    assert len(ways & driven) == 43


@pytest.fixture(scope="module")
def dead_end(road_map: RoadMap) -> Town:
    """One street of the ladder, cut off from the others."""
    street = replace(road_map.roads["1"], predecessor=None, successor=None)
    return build_town(
        RoadMap("dead end", {"1": street}), name="dead end", timing=LightTiming(), digest=""
    )


def _assert_sound(town: Town, route: Route) -> None:
    gaps = np.hypot(*np.diff(route.points, axis=0).T)
    np.testing.assert_allclose(gaps[:-1], 1.0, atol=0.02)
    assert 0.0 < gaps[-1] <= 1.0 + 1e-9
    np.testing.assert_allclose(np.diff(route.station)[:-1], 1.0)
    assert np.all(np.diff(route.lane_index) >= 0)
    assert (route.lane_index[0], route.lane_index[-1]) == (0, len(route.lanes) - 1)
    for point, yaw, index in zip(
        route.points[::7], route.yaw[::7], route.lane_index[::7], strict=True
    ):
        lane = town.lanes[route.lanes[index]].centerline
        nearest = np.argmin(np.hypot(*(lane - point).T))
        assert np.hypot(*(lane[nearest] - point)) < 0.3
        assert np.cos(headings(lane)[nearest] - yaw) > 0.97


@given(seed=st.integers(0, 10_000), length=st.floats(20.0, 1500.0))
def test_random_routes_follow_the_lanes_for_their_length(seed: int, length: float) -> None:
    town = library.load("town02")
    rng = np.random.default_rng(seed)
    lane, station = routing.random_start(town, rng)
    route = routing.random_route(town, lane=lane, station=station, length=length, rng=rng)
    assert route.station[-1] == pytest.approx(length)
    assert route.lanes[0] == lane
    _assert_sound(town, route)


def test_random_routes_choose_every_way_equally_often(ladder: Town) -> None:
    rng = np.random.default_rng(3)
    routes = [
        routing.random_route(ladder, lane="1/0/-1", station=30.0, length=15.0, rng=rng)
        for _ in range(400)
    ]
    moves = [ladder.lanes[route.lanes[1]].move for route in routes]
    assert 160 < moves.count(Move.LEFT) < 240
    assert moves.count(Move.LEFT) + moves.count(Move.STRAIGHT) == 400


def test_the_same_generator_gives_the_same_route(ladder: Town) -> None:
    first, second = (
        routing.random_route(
            ladder, lane="1/0/-1", station=1.0, length=500.0, rng=np.random.default_rng(5)
        )
        for _ in range(2)
    )
    np.testing.assert_array_equal(first.points, second.points)


@given(seed=st.integers(0, 10_000))
def test_random_starts_keep_clear_of_junctions(seed: int) -> None:
    town = library.load("town01")
    name, station = routing.random_start(town, np.random.default_rng(seed))
    assert town.lanes[name].junction is None
    assert 0.0 <= station <= lane_length(town.lanes[name]) - 15.0


@pytest.mark.parametrize(
    ("name", "first", "second"),
    [
        ("town01", ("12/0/-1", 48.893), ("10/0/1", 20.268)),
        ("town02", ("12/0/-1", 75.236), ("12/0/1", 46.727)),
        ("town03", ("12/0/-1", 16.971), ("11/0/-1", 15.32)),
    ],
)
@pytest.mark.parametrize("length", [0.0, 5000.0])
def test_seeds_keep_their_starts(
    name: str, first: tuple[str, float], second: tuple[str, float], length: float
) -> None:
    town = library.load(name)
    for seed, (lane, station) in enumerate([first, second]):
        start = routing.random_start(town, np.random.default_rng(seed), length=length)
        assert start == (lane, pytest.approx(station, abs=1e-3))


def _open_street(road_map: RoadMap) -> Town:
    street = replace(road_map.roads["7"], predecessor=None, successor=None)
    alone = RoadMap("street", {"7": street})
    return build_town(alone, name="street", timing=LightTiming(), digest="")


@given(seed=st.integers(0, 10_000), share=st.floats(0.05, 0.99))
def test_in_a_town_with_open_ends_drives_start_where_the_way_is_long_enough(
    road_map: RoadMap, seed: int, share: float
) -> None:
    town = _open_street(road_map)
    length = share * max(map(lane_length, town.lanes.values()))
    rng = np.random.default_rng(seed)
    lane, station = routing.random_start(town, rng, length=length)
    route = routing.random_route(town, lane=lane, station=station, length=length, rng=rng)
    assert route.station[-1] == pytest.approx(length)


def test_where_no_way_is_long_enough_the_error_says_what_to_do(road_map: RoadMap) -> None:
    town = _open_street(road_map)
    rng = np.random.default_rng(0)
    lane, station = routing.random_start(town, rng, length=1e4)
    with pytest.raises(
        RouteError, match=r"From station \d+\.\d m .* 10000\.0 m\. .*--steps.*--seed"
    ):
        routing.random_route(town, lane=lane, station=station, length=1e4, rng=rng)


@given(seed=st.integers(0, 10_000))
def test_a_place_on_a_lane_is_found_again_with_its_heading(seed: int) -> None:
    town = library.load("town01")
    rng = np.random.default_rng(seed)
    name = str(rng.choice(list(town.lanes)))
    line = town.lanes[name].centerline
    yaw = headings(line)
    index = int(rng.integers(len(line)))
    left = np.array([-np.sin(yaw[index]), np.cos(yaw[index])])
    offset = float(rng.uniform(-0.3, 0.3))
    found, projection = routing.nearest_lane(
        town, line[index] + offset * left, yaw=float(yaw[index])
    )
    if town.lanes[name].junction is None and 0 < index < len(line) - 1:
        assert found == name
        assert projection.offset == pytest.approx(offset, abs=2e-3)
        assert projection.station == pytest.approx(stations(line)[index], abs=0.2)
    assert abs(projection.offset) <= abs(offset) + 0.1


def test_the_heading_tells_the_two_directions_of_a_street_apart(ladder: Town) -> None:
    middle = np.array([30.0, 0.3])
    assert routing.nearest_lane(ladder, middle)[0] == "1/0/1"
    assert routing.nearest_lane(ladder, middle, yaw=0.0)[0] == "1/0/-1"
    assert routing.nearest_lane(ladder, middle, yaw=np.pi)[0] == "1/0/1"


def test_a_route_on_one_lane_is_trimmed_to_its_waypoints(ladder: Town) -> None:
    route = routing.route_through(ladder, np.array([[15.0, -1.5], [40.5, -2.5]]))
    assert route.lanes == ("1/0/-1",)
    np.testing.assert_allclose(route.points[[0, -1]], [[15.0, -2.0], [40.5, -2.0]], atol=1e-9)
    assert len(route.points) == 27
    np.testing.assert_allclose(route.curvature, 0.0, atol=1e-9)
    np.testing.assert_allclose(route.yaw, 0.0, atol=1e-9)


def test_a_place_behind_on_the_same_lane_is_reached_around_the_block(ladder: Town) -> None:
    route = routing.route_through(ladder, np.array([[40.0, -2.0], [15.0, -2.0]]))
    assert route.lanes[0] == route.lanes[-1] == "1/0/-1"
    assert route.station[-1] > 200.0


def test_curvature_of_a_route_is_one_over_the_radius(ladder: Town) -> None:
    route = routing.route_through(ladder, np.array([[100.0, -2.0], [122.0, 30.0]]))
    assert route.curvature.max() == pytest.approx(1.0 / 11.0, rel=0.02)  # 9 m and half the street


@pytest.mark.parametrize(
    ("waypoints", "complaint"),
    [
        ([[15.0, -2.0]], "1 waypoints; expected two or more"),
        ([[15.0, -2.0], [30.0, 30.0]], r"Waypoint 1 \(30\.0, 30\.0\) lies on no lane; the nearest"),
        ([[15.0, -2.0], [15.4, -2.0]], "expected at least 1.0 m"),
    ],
)
def test_impossible_waypoints_are_refused(
    ladder: Town, waypoints: list[list[float]], complaint: str
) -> None:
    with pytest.raises(RouteError, match=complaint):
        routing.route_through(ladder, np.array(waypoints))


def test_a_waypoint_that_cannot_be_reached_is_named(dead_end: Town) -> None:
    with pytest.raises(
        RouteError, match=r"Waypoint 1 \(30\.0, 2\.0\) cannot be reached from waypoint 0"
    ):
        routing.route_through(dead_end, np.array([[15.0, -2.0], [30.0, 2.0]]))


def test_a_random_route_into_a_dead_end_is_refused(dead_end: Town) -> None:
    with pytest.raises(
        RouteError, match=r"'1/0/-1' the lanes lead on for 33\.0 m; expected 100\.0 m"
    ):
        routing.random_route(
            dead_end, lane="1/0/-1", station=5.0, length=100.0, rng=np.random.default_rng(0)
        )


@pytest.fixture(scope="module")
def roundabout(roundabout_map: RoadMap) -> Town:
    return build_town(roundabout_map, name="roundabout", timing=LightTiming(), digest="")


@given(seed=st.integers(0, 10_000))
def test_random_routes_go_round_rather_than_out_into_the_open(roundabout: Town, seed: int) -> None:
    rng = np.random.default_rng(seed)
    lane, station = routing.random_start(roundabout, rng)
    assert lane not in ("e/0/1", "w/0/1"), "that way the town ends"
    route = routing.random_route(roundabout, lane=lane, station=station, length=300.0, rng=rng)
    assert route.station[-1] == pytest.approx(300.0)
    # A way out leads on for less than 60 m.
    before = route.lanes[: route.lane_index[np.searchsorted(route.station, 240.0)]]
    assert not {"e2/0/-1", "w2/0/-1"} & set(before)


def test_a_random_route_that_is_short_enough_may_end_in_a_dead_end(roundabout: Town) -> None:
    rng = np.random.default_rng(0)
    routes = [
        routing.random_route(roundabout, lane="n/0/-1", station=0.0, length=60.0, rng=rng)
        for _ in range(20)
    ]
    assert {"w/0/1", "w3/0/-1"} <= {lane for route in routes for lane in route.lanes}
    for route in routes:
        assert route.station[-1] == pytest.approx(60.0)


def test_a_random_route_must_start_on_a_lane(ladder: Town) -> None:
    with pytest.raises(UnknownNameError, match="Unknown lane '1/0/-2'"):
        routing.random_route(
            ladder, lane="1/0/-2", station=0.0, length=10.0, rng=np.random.default_rng(0)
        )
    with pytest.raises(RouteError, match=r"Station 50\.0 m is not on lane '1/0/-1'"):
        routing.random_route(
            ladder, lane="1/0/-1", station=50.0, length=10.0, rng=np.random.default_rng(0)
        )


def test_without_long_lanes_there_is_no_start(ladder: Town) -> None:
    crossing = {name: lane for name, lane in ladder.lanes.items() if lane.junction is not None}
    town = Town(name="crossing", lanes=crossing, lights={}, bounds=ladder.bounds, digest="")
    with pytest.raises(RouteError, match="no lane outside junctions"):
        routing.random_start(town, np.random.default_rng(0))
