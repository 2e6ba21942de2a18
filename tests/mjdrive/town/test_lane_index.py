import dataclasses

import numpy as np
import pytest
import shapely

from mjdrive import geometry
from mjdrive.datatypes import Lane, Town
from mjdrive.town import surface
from mjdrive.town.lane_index import REACH, LaneIndex


def town_of(*lanes: Lane) -> Town:
    return Town("small", {lane.id: lane for lane in lanes}, {}, np.zeros(4), "")


def lane_of(points: list[tuple[float, float]], **fields) -> Lane:
    return Lane("lane", np.array(points, float), 4.0, (), None, None, **fields)


@pytest.fixture(scope="module")
def index(town02: Town) -> LaneIndex:
    return LaneIndex(town02)


def random_points(town: Town, count: int) -> np.ndarray:
    return np.random.default_rng(2).uniform(town.bounds[:2], town.bounds[2:], (count, 2))


def test_places_under_a_point_are_the_lane_polygons_that_cover_it(
    town02: Town, index: LaneIndex
) -> None:
    polygons = surface.lane_polygons(town02)
    names = list(polygons)
    tree = shapely.STRtree([polygons[name] for name in names])
    edges = shapely.union_all([polygon.exterior for polygon in polygons.values()])
    compared = 0
    for x, y in random_points(town02, 2000).tolist():
        point = shapely.Point(x, y)
        if shapely.distance(edges, point) > 0.05:  # rounding decides nothing
            expected = {names[number] for number in tree.query(point, predicate="intersects")}
            assert {place.lane for place in index.under(x, y)} == expected
            compared += len(expected)
    assert compared > 200


def test_places_near_a_point_are_projections(town02: Town, index: LaneIndex) -> None:
    for x, y in random_points(town02, 60).tolist():
        places = {place.lane: place for place in index.near(x, y)}
        for name, lane in town02.lanes.items():
            expected = geometry.project(lane.centerline, np.array([x, y]))
            if abs(expected.offset) < REACH:
                assert places[name].station == pytest.approx(expected.station, abs=1e-6)
                assert places[name].offset == pytest.approx(expected.offset, abs=1e-6)


@pytest.mark.parametrize(
    ("x", "y", "is_inside"),
    [
        (5.0, 1.99, True),
        (5.0, 2.05, False),
        (0.0, 0.0, True),
        (-0.005, 0.0, True),
        (-0.05, 0.0, False),
        (10.05, 0.0, False),
        (5.0, -1.99, True),
        (5.0, -2.05, False),
    ],
)
def test_a_lane_ends_at_its_edges_and_ends(x: float, y: float, is_inside: bool) -> None:
    index = LaneIndex(town_of(lane_of([(0, 0), (4, 0), (10, 0)])))
    assert bool(index.under(x, y)) == is_inside


def test_the_outer_side_of_a_bend_belongs_to_the_lane() -> None:
    index = LaneIndex(town_of(lane_of([(0, 0), (10, 0), (10, 10)])))
    (place,) = index.under(11.0, -1.0)
    assert place.station == pytest.approx(10.0)
    assert place.offset == pytest.approx(-np.sqrt(2))


def test_width_may_change_along_a_lane() -> None:
    widths = np.array([2.0, 4.0, 4.0])
    index = LaneIndex(town_of(lane_of([(0, 0), (10, 0), (20, 0)], widths=widths)))
    (place,) = index.near(5.0, 1.4)
    assert place.half_width == pytest.approx(1.5)
    assert place.is_inside
    assert not index.under(5.0, 1.6)
    assert index.under(15.0, 1.6)


def test_far_from_every_lane_there_is_none() -> None:
    index = LaneIndex(town_of(lane_of([(0, 0), (10, 0)])))
    assert index.near(1000.0, 1000.0) == []
    assert index.under(1000.0, 1000.0) == []


def test_moving_the_world_moves_the_places(town02: Town) -> None:
    motion = {"x": 812.5, "y": -77.25, "yaw": 1.1}
    lanes = {
        name: dataclasses.replace(
            lane, centerline=geometry.world_from_vehicle(lane.centerline, **motion)
        )
        for name, lane in town02.lanes.items()
    }
    here, there = LaneIndex(town02), LaneIndex(dataclasses.replace(town02, lanes=lanes))
    points = random_points(town02, 200)
    for old, new in zip(points, geometry.world_from_vehicle(points, **motion), strict=True):
        before, after = ({p.lane: p for p in i.under(*at)} for i, at in ((here, old), (there, new)))
        assert before.keys() == after.keys()
        for name, place in before.items():
            assert after[name].station == pytest.approx(place.station, abs=1e-6)
            assert after[name].offset == pytest.approx(place.offset, abs=1e-6)
