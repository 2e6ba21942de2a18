import functools
from dataclasses import replace

import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Lane, StaticObject, Town
from mjdrive.errors import ConfigError
from mjdrive.town import library, surface
from mjdrive.town.scenery import Scenery, lay_out
from mjdrive.town.settings import SceneryConfig

TOWNS = library.shipped_names()
NO_TREES = SceneryConfig(tree_spacing=0.0, garden_tree_spacing=0.0)


@functools.cache
def layout(name: str) -> Scenery:
    return lay_out(library.load(name), library.load_settings(name).scenery)


def straight(length: float = 200.0, **more: object) -> Town:
    """One eastbound lane, 4 m wide."""
    lane = Lane("a", np.array([[0.0, 0.0], [length, 0.0]]), 4.0, (), None, None)
    bounds = np.array([0.0, -2.0, length, 2.0])
    return Town("straight", {"a": lane}, {}, bounds, "", **more)


def ring_road(radius: float) -> Town:
    """A lane that runs counter-clockwise around an island."""
    angle = np.linspace(0.0, 2 * np.pi, 181)
    centerline = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    lane = Lane("a", centerline, 4.0, ("a",), None, None)
    return Town("ring", {"a": lane}, {}, np.array([-1.0, -1.0, 1.0, 1.0]) * (radius + 2.0), "")


def trunks(scenery: Scenery) -> list[shapely.Polygon]:
    return [shapely.Point(tree.x, tree.y).buffer(tree.trunk_radius) for tree in scenery.trees]


@pytest.mark.parametrize("name", TOWNS)
def test_houses_leave_road_sidewalk_verge_and_each_other_alone(name):
    scenery = layout(name)
    houses = [house.footprint() for house in scenery.buildings]
    assert len(houses) > 20
    ground = shapely.union_all([scenery.road, scenery.sidewalk, scenery.verge])
    assert not np.any(shapely.intersects(houses, ground))
    assert shapely.union_all(houses).area == pytest.approx(sum(house.area for house in houses))


@pytest.mark.parametrize("name", TOWNS)
def test_trees_stand_in_verges_and_gardens_alone(name):
    scenery = layout(name)
    houses = [house.footprint() for house in scenery.buildings]
    elsewhere = shapely.union_all([scenery.road, scenery.sidewalk, *houses])
    assert len(scenery.trees) > 20
    assert not np.any(shapely.intersects(elsewhere, trunks(scenery)))


@pytest.mark.parametrize("name", TOWNS)
def test_street_trees_stand_wholly_on_the_verge_and_hide_no_junction(name):
    town = library.load(name)
    scenery = lay_out(town, replace(library.load_settings(name).scenery, garden_tree_spacing=0.0))
    lanes = surface.lane_polygons(town)
    crossed = shapely.union_all([lanes[lane.id] for lane in town.lanes.values() if lane.junction])
    assert len(scenery.trees) > 10
    assert shapely.contains(scenery.verge, trunks(scenery)).all()
    assert shapely.distance(crossed, trunks(scenery)).min() > 7.0


@pytest.mark.parametrize("name", TOWNS)
def test_road_sidewalk_and_verge_do_not_overlap(name):
    scenery = layout(name)
    parts = [scenery.road, scenery.sidewalk, scenery.verge]
    assert shapely.union_all(parts).area == pytest.approx(sum(part.area for part in parts))
    assert shapely.covers(scenery.road, surface.driving_surface(library.load(name)))


def test_same_seed_gives_the_same_bytes_and_another_seed_others():
    town = library.load("town02")
    first, again = (lay_out(town, SceneryConfig(seed=3)) for _ in range(2))
    assert (first.buildings, first.trees) == (again.buildings, again.trees)
    assert first.sidewalk.wkb == again.sidewalk.wkb
    other = lay_out(town, SceneryConfig(seed=4))
    assert other.buildings != first.buildings
    assert other.trees != first.trees


def test_straight_road_has_kerb_verge_and_sidewalk_of_the_given_widths():
    scenery = lay_out(straight(), SceneryConfig(sidewalk_width=5.0, verge_width=1.5))
    across = shapely.LineString([(100.0, 0.0), (100.0, 50.0)])
    assert across.intersection(scenery.road).length == pytest.approx(2.3, abs=0.1)
    assert across.intersection(scenery.verge).length == pytest.approx(1.5, abs=0.1)
    assert across.intersection(scenery.sidewalk).length == pytest.approx(5.0 - 1.65, abs=0.1)


def test_island_of_a_roundabout_is_no_road():
    scenery = lay_out(ring_road(7.0), NO_TREES)
    assert not scenery.road.contains(shapely.Point(0.0, 0.0))
    assert scenery.verge.contains(shapely.Point(0.0, 0.0))
    assert not any(
        house.footprint().intersects(shapely.box(-5, -5, 5, 5)) for house in scenery.buildings
    )
    inner_radius = shapely.distance(scenery.road, shapely.Point(0.0, 0.0))
    assert inner_radius == pytest.approx(5.0 - 0.3, abs=0.1)


def test_no_room_means_no_houses():
    wide = replace(NO_TREES, building_width=(300.0, 400.0))
    assert lay_out(straight(), wide).buildings == ()


def test_houses_leave_buildings_of_the_map_alone():
    square = np.array([[-40.0, 5.0], [240.0, 5.0], [240.0, 40.0], [-40.0, 40.0]])
    hall = StaticObject(id="hall", type="building", outline=square, height=8.0)
    with_hall = lay_out(straight(objects=(hall,)), NO_TREES)
    assert with_hall.buildings
    outline = shapely.Polygon(square)
    assert not any(outline.intersects(house.footprint()) for house in with_hall.buildings)


def test_sidewalks_of_the_map_are_where_the_map_says():
    strip = np.array([[0.0, 4.0], [200.0, 4.0], [200.0, 6.0], [0.0, 6.0]])
    scenery = lay_out(straight(sidewalks=(strip,)), NO_TREES)
    assert scenery.sidewalk.contains(shapely.Point(100.0, 5.0))
    assert scenery.verge.contains(shapely.Point(100.0, 3.0))


def test_houses_look_at_their_street():
    for house in lay_out(straight(), NO_TREES).buildings:
        left = np.array([-np.sin(house.yaw), np.cos(house.yaw)])
        if 10.0 < house.x < 190.0:
            assert left @ np.array([0.0, -house.y]) > 0.0


def test_verge_that_leaves_no_sidewalk_is_refused():
    with pytest.raises(ConfigError, match="1 m more than verge_width"):
        SceneryConfig(sidewalk_width=2.0, verge_width=1.5)
