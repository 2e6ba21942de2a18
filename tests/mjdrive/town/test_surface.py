from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Town
from mjdrive.town import library, surface
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.opendrive.road_shapes import Cubic
from mjdrive.town.settings import LightTiming

TOWNS = library.shipped_names()
BLOCKS = {"town01": 7, "town02": 5, "town03": 7}
"""City blocks, all over 1,900 m2."""

ISLANDS = {"town01": 0, "town02": 0, "town03": 1}
"""Of roundabouts."""


def test_the_area_of_a_lane_is_length_times_width(ladder: Town) -> None:
    polygons = surface.lane_polygons(ladder)
    assert set(polygons) == set(ladder.lanes)
    assert polygons["1/0/-1"].area == pytest.approx(38.0 * 4.0)


def test_the_surface_of_the_ladder_is_known(ladder: Town) -> None:
    road = surface.driving_surface(ladder)
    assert isinstance(road, shapely.Polygon)
    assert len(road.interiors) == 2
    np.testing.assert_allclose(road.bounds, [-4.0, -4.0, 124.0, 84.0], atol=1e-6)
    # Streets of 8 m, 120 x 80 m around and 72 m across. A square corner minus its quarter circle is 1 - pi / 4 of
    # the radius squared: outside and inside of four bends of 9 m, and four kerb returns of 5 m less half a lane.
    spandrel = 1.0 - np.pi / 4.0
    area = 2 * 120 * 8 + 2 * 80 * 8 + 72 * 8 + 4 * spandrel * (-(13.0**2) + 5.0**2 + 3.0**2)
    assert road.area == pytest.approx(area, abs=1.0)


@pytest.mark.parametrize("name", TOWNS)
def test_roads_are_one_area_around_the_city_blocks(name: str) -> None:
    town = library.load(name)
    road = surface.road_surface(town)
    assert isinstance(surface.driving_surface(town), shapely.Polygon)
    assert isinstance(road, shapely.Polygon)
    assert road.is_valid
    areas = [shapely.Polygon(ring).area for ring in road.interiors]
    assert sum(area > 1900.0 for area in areas) == BLOCKS[name]
    assert sum(area <= 1900.0 for area in areas) == ISLANDS[name]


@pytest.mark.parametrize("name", TOWNS)
def test_kerbs_stand_a_gutter_away_from_every_lane(name: str) -> None:
    town = library.load(name)
    kerbs = surface.road_surface(town, shoulder=0.3).boundary
    distances = [
        kerbs.distance(shapely.LineString(lane.centerline)) for lane in town.lanes.values()
    ]
    assert min(distances) > 2.3 - 0.011
    outside = [
        distance
        for distance, lane in zip(distances, town.lanes.values(), strict=True)
        if lane.junction is None
    ]
    assert max(outside) < 2.3 + 0.011


@pytest.mark.parametrize("name", TOWNS)
def test_kerbs_have_no_spikes(name: str) -> None:
    road = surface.road_surface(library.load(name))
    for ring in (road.exterior, *road.interiors):
        steps = np.diff(np.array(ring.coords), axis=0)
        steps = np.vstack([steps, steps[:1]])
        turns = np.abs(np.angle(np.exp(1j * np.diff(np.arctan2(steps[:, 1], steps[:, 0])))))
        assert turns.max() < np.deg2rad(60.0)


def test_a_wider_gutter_gives_a_wider_road(ladder: Town) -> None:
    narrow, wide = (surface.road_surface(ladder, shoulder=shoulder) for shoulder in (0.3, 1.0))
    assert wide.contains(narrow)


def _town(road_map: RoadMap) -> Town:
    return build_town(road_map, name="small", timing=LightTiming(), digest="")


def test_edges_lie_half_a_width_beside_the_centre(ladder: Town) -> None:
    left, right = surface.edges(ladder.lanes["1/0/-1"])
    np.testing.assert_allclose(left[[0, -1]], [[10.0, 0.0], [48.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(right[[0, -1]], [[10.0, -4.0], [48.0, -4.0]], atol=1e-9)


@pytest.mark.parametrize("name", TOWNS)
def test_lanes_lie_between_their_edges(name: str) -> None:
    town = library.load(name)
    polygons = surface.lane_polygons(town)
    for lane in town.lanes.values():
        left, right = surface.edges(lane)
        outline = shapely.Polygon(np.concatenate([right, left[::-1]]))
        if outline.is_valid:  # the inner edge of a tight bend may cross itself
            assert outline.symmetric_difference(polygons[lane.id]).area < 0.01 * outline.area


def test_a_lane_that_tapers_is_a_wedge(maker: Any) -> None:
    taper = maker.lane(-1, widths=(Cubic(0.0, 4.0, -0.1),))
    town = _town(maker.map([maker.road("1", ((0, 0), (40, 0)), maker.section(taper))]))
    left, right = surface.edges(town.lanes["1/0/-1"])
    np.testing.assert_allclose(left[-1], right[-1], atol=0.01)
    wedge = surface.lane_polygons(town)["1/0/-1"]
    assert wedge.geom_type == "Polygon"
    assert wedge.area == pytest.approx(80.0, rel=0.002)
    assert wedge.contains(shapely.Point(10.0, -1.5))
    assert not wedge.intersects(shapely.Point(30.0, -1.5))


def test_the_middle_of_a_roundabout_is_an_island(roundabout_map: RoadMap) -> None:
    """However small: one of 6.25 m radius, less the gutter, is 111 m2."""
    road = surface.road_surface(_town(roundabout_map), shoulder=0.3)
    (island,) = [
        ring for ring in road.interiors if shapely.Polygon(ring).contains(shapely.Point(0, 0))
    ]
    assert shapely.Polygon(island).area == pytest.approx(np.pi * 5.95**2, rel=0.02)


def test_a_strip_between_two_directions_is_an_island(maker: Any) -> None:
    """A street that parts its directions by 3 m of grass, and joins them at both ends."""
    grass = [maker.lane(side, type="none", width=1.5) for side in (1, -1)]
    parted = maker.section(*grass, 2, -2)
    ends = [maker.section(1, -1) for _ in range(2)]
    roads = [
        maker.road("a", ((-20, 0), (0, 0)), ends[0]),
        maker.road("b", ((0, 0), (40, 0)), parted),
        maker.road("c", ((40, 0), (60, 0)), ends[1]),
    ]
    road = surface.road_surface(_town(maker.map(roads)), shoulder=0.0)
    (strip,) = road.interiors
    assert shapely.Polygon(strip).area == pytest.approx(3.0 * 40.0, rel=0.02)


def test_leftovers_inside_a_junction_are_road(maker: Any) -> None:
    """Four lanes across one junction leave a square of 12 m between them, and no kerb."""
    across = [
        (((-20, 6), (20, 6)), "1"),
        (((20, -6), (-20, -6)), "2"),
        (((6, 20), (6, -20)), "3"),
        (((-6, -20), (-6, 20)), "4"),
    ]
    offset = (Cubic(0.0, 1.75),)
    roads = [
        maker.road(name, ends, maker.section(-1), junction="J", lane_offsets=offset)
        for ends, name in across
    ]
    inside = surface.road_surface(_town(maker.map(roads, [maker.junction("J")])))
    assert len(inside.interiors) == 0
    outside = [replace(road, junction=None) for road in roads]
    assert len(surface.road_surface(_town(maker.map(outside))).interiors) == 1
