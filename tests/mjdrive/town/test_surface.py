import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Town
from mjdrive.town import library, surface

TOWNS = library.town_names()
BLOCKS = {"town01": 7, "town02": 5}


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
    for area in (surface.driving_surface(town), surface.road_surface(town)):
        assert isinstance(area, shapely.Polygon)
        assert area.is_valid
        assert len(area.interiors) == BLOCKS[name]
        assert min(shapely.Polygon(ring).area for ring in area.interiors) > 1900.0


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
