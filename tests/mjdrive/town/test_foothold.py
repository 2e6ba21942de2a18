import math

import numpy as np
import pytest
import shapely

from mjdrive import geometry
from mjdrive.datatypes import Lane, Town
from mjdrive.town import surface
from mjdrive.town.foothold import LEAST_COSINE, MARGIN, Foothold
from mjdrive.town.lane_index import LaneIndex


def straight_lane(length: float = 50.0, width: float = 4.0) -> Town:
    points = np.column_stack([np.arange(0.0, length + 1.0), np.zeros(int(length) + 1)])
    lane = Lane("lane", points, width, (), None, None)
    return Town("small", {"lane": lane}, {}, np.zeros(4), "")


def foothold_at(index: LaneIndex, x: float, y: float) -> Foothold:
    foothold = Foothold(index)
    foothold.set_on(index.under(x, y)[0])
    return foothold


def test_what_a_foothold_holds_the_whole_index_and_the_road_confirm(town02: Town) -> None:
    index, rng = LaneIndex(town02), np.random.default_rng(0)
    road = surface.road_surface(town02, shoulder=0.0)
    num_held = num_asked = 0
    for lane in town02.lanes.values():
        station = geometry.stations(lane.centerline)
        yaw_along = np.unwrap(geometry.headings(lane.centerline))
        foothold = Foothold(index)
        for along in np.arange(0.3, station[-1], 0.6).tolist():
            yaw = float(np.interp(along, station, yaw_along))
            offset = float(rng.normal(0.0, 1.0))
            x, y = (float(np.interp(along, station, axis)) for axis in lane.centerline.T)
            x, y = x - offset * math.sin(yaw), y + offset * math.cos(yaw)
            yaw += float(rng.normal(0.0, 0.8))
            places = index.under(x, y)
            num_asked += 1
            if foothold.holds(x, y, yaw):
                num_held += 1
                assert any(math.cos(yaw - place.yaw) >= 0.0 for place in places)
                assert shapely.contains_xy(road, x, y)
            elif mine := [place for place in places if place.lane == lane.id]:
                foothold.set_on(mine[0])
    assert num_held > 0.4 * num_asked > 1000


def test_foothold_goes_along_with_the_car_and_ends_with_the_lane() -> None:
    foothold = foothold_at(LaneIndex(straight_lane()), 0.5, 0.0)
    assert all(foothold.holds(x, 0.3, 0.0) for x in np.arange(0.5, 50.0, 0.7).tolist())
    assert not foothold.holds(50.5, 0.3, 0.0)
    assert not foothold.holds(49.0, 0.3, 0.0)  # it has let go


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_near_an_edge_or_across_the_lane_nothing_is_certain(side: float) -> None:
    foothold = foothold_at(LaneIndex(straight_lane()), 5.5, 0.0)
    most, turn = 2.0 - MARGIN, math.acos(LEAST_COSINE)
    assert foothold.holds(5.5, side * (most - 0.01), 0.0)
    assert not foothold.holds(5.5, side * (most + 0.01), 0.0)
    assert foothold.holds(5.5, 0.0, side * (turn - 0.01))
    assert not foothold.holds(5.5, 0.0, side * (turn + 0.01))
    assert not foothold.holds(4.5, 0.0, 0.0)  # backwards beyond its segment


def test_without_a_lane_nothing_is_certain() -> None:
    assert not Foothold(LaneIndex(straight_lane())).holds(5.0, 0.0, 0.0)
