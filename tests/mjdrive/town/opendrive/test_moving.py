from dataclasses import replace

import numpy as np
import pytest

from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import LightTiming


def test_a_map_near_its_origin_stays(road_map: RoadMap) -> None:
    assert opendrive.near_origin(road_map) == (0.0, 0.0)
    assert opendrive.moved(road_map, (0.0, 0.0)) is road_map


def test_a_map_of_a_survey_comes_to_the_origin_and_is_the_same_town(rich_bytes: bytes) -> None:
    here = opendrive.parse(rich_bytes, source="rich")
    away = opendrive.moved(here, (-692_000.0, -5_335_000.0))
    origin = opendrive.near_origin(away)
    assert origin == pytest.approx((692_000.0, 5_335_000.0), abs=2000.0)
    assert np.remainder(origin, 100.0).tolist() == [0.0, 0.0]
    back = opendrive.moved(away, origin)
    shift = np.array([692_000.0, 5_335_000.0]) - origin
    towns = [
        build_town(road_map, name="rich", timing=LightTiming(), digest="")
        for road_map in (here, back)
    ]
    first, second = towns
    assert first.lanes.keys() == second.lanes.keys()
    for name, lane in first.lanes.items():
        np.testing.assert_allclose(
            second.lanes[name].centerline, lane.centerline + shift, atol=1e-6
        )
    for thing, again in zip(first.objects, second.objects, strict=True):
        np.testing.assert_allclose(again.outline, thing.outline + shift, atol=1e-6)


def test_one_far_road_is_enough_to_move(road_map: RoadMap) -> None:
    road = road_map.roads["1"]
    far = replace(road, pieces=tuple(replace(piece, x=piece.x + 1e5) for piece in road.pieces))
    x, y = opendrive.near_origin(replace(road_map, roads={**road_map.roads, "1": far}))
    assert (x, y) == (pytest.approx(50_000.0, abs=100.0), 0.0)
