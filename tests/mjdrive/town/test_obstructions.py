from dataclasses import replace

import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Lane, Sign, StaticObject, Town
from mjdrive.town import surface
from mjdrive.town.check import FindingKind, Severity, check
from mjdrive.town.obstructions import obstructions
from mjdrive.town.scenery import standing
from mjdrive.town.surface import driving_surface, lane_polygons


def _thing(town: Town, *, type: str = "barrier", height: float = 1.0, aside: float = 0.0) -> Town:
    """Put a square of 1 m beside the middle of the first lane, `aside` to its left [m]."""
    lane = next(iter(town.lanes.values()))
    middle = len(lane.centerline) // 2
    along = lane.centerline[middle + 1] - lane.centerline[middle]
    left = np.array([-along[1], along[0]]) / np.hypot(*along)
    x, y = lane.centerline[middle] + aside * left
    outline = shapely.get_coordinates(shapely.box(x - 0.5, y - 0.5, x + 0.5, y + 0.5))[:-1]
    return replace(town, objects=(StaticObject("thing", type, outline, height),))


def test_nothing_stands_on_the_lanes_of_a_sound_town(ladder: Town) -> None:
    assert list(obstructions(ladder)) == []


def test_a_thing_on_a_lane_is_an_error_that_names_both(ladder: Town) -> None:
    (finding,) = check(_thing(ladder))
    name = next(iter(ladder.lanes))
    assert (finding.kind, finding.severity, finding.where) == (
        FindingKind.ON_LANE,
        Severity.ERROR,
        "thing",
    )
    assert "The barrier stands at (" in finding.text
    assert f"on lane '{name}'" in finding.text


@pytest.mark.parametrize(
    ("thing", "in_the_way"),
    [
        ({"height": 0.05}, False),
        ({"height": 0.06}, True),
        ({"aside": -40.0}, False),
        ({"type": "tree"}, True),
    ],
)
def test_what_a_car_runs_into_is_in_the_way(
    ladder: Town, thing: dict[str, object], in_the_way: bool
) -> None:
    town = _thing(ladder, **thing)
    assert bool(list(obstructions(town))) is in_the_way


def test_what_the_scenery_lays_flat_is_in_nobodys_way(ladder: Town) -> None:
    for height in (0.0, 0.04, 0.05, 0.051, 0.1, 3.0):
        town = _thing(ladder, height=height)
        assert bool(list(obstructions(town))) is bool(standing(town))


def test_crowns_of_trees_may_hang_over_a_lane(ladder: Town) -> None:
    road = driving_surface(ladder)
    left, bottom, _, top = road.bounds
    middle = (bottom + top) / 2
    beside = shapely.box(left - 4.0, middle - 3.0, left + 2.0, middle + 3.0)
    assert beside.intersects(road)
    assert beside.centroid.distance(road) > 0.5
    outline = shapely.get_coordinates(beside)[:-1]
    tree, house = (
        replace(ladder, objects=(StaticObject("thing", kind, outline, 6.0),))
        for kind in ("tree", "building")
    )
    assert list(obstructions(tree)) == []
    assert len(list(obstructions(house))) == 1


def test_poles_and_signs_on_lanes_are_found_once_each(ladder: Town) -> None:
    (name, ground), *_ = lane_polygons(ladder).items()
    x, y = ground.representative_point().coords[0]
    first, *others = ladder.lights.values()
    light = replace(first, pole=np.array([x, y]), signal="gantry")
    twin = replace(light, id="twin")
    town = replace(
        ladder,
        lights={light.id: light, "twin": twin, **{other.id: other for other in others}},
        signs=(Sign("limit", "274", 50.0, "km/h", x, y, 0.0),),
    )
    found = [(found.what, found.thing, found.lanes[0]) for found in obstructions(town)]
    assert found == [("light", "gantry", name), ("sign", "limit", name)]


def test_lanes_that_nothing_stands_near_are_not_outlined(
    town01: Town, monkeypatch: pytest.MonkeyPatch
) -> None:
    outlined = []

    def counted(lane: Lane) -> shapely.Polygon:
        outlined.append(lane.id)
        return surface.outline(lane)

    monkeypatch.setattr("mjdrive.town.obstructions.outline", counted)
    assert list(obstructions(replace(town01, signs=(), objects=()))) == []
    near = {
        lane.id
        for lane in town01.lanes.values()
        for light in town01.lights.values()
        if shapely.distance(shapely.LineString(lane.centerline), shapely.Point(light.pole)) < 5.0
    }
    assert len(outlined) == len(set(outlined))
    assert set(outlined) <= near
    assert 0 < len(outlined) < len(town01.lanes)
