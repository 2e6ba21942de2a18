import re
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from mjdrive.datatypes import Move, Signal, Town
from mjdrive.errors import TownFormatError
from mjdrive.geometry import headings, stations, wrap_angle
from mjdrive.town import library, opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap, SignalReference
from mjdrive.town.opendrive.road_shapes import Piece
from mjdrive.town.settings import LightTiming

TOWNS = library.shipped_names()


def _build(road_map: RoadMap) -> Town:
    return build_town(road_map, name="test", timing=LightTiming(), digest="")


@pytest.mark.parametrize("name", TOWNS)
def test_lanes_meet_their_successors_without_gap_or_kink(name: str) -> None:
    town = library.load(name)
    for lane in town.lanes.values():
        assert lane.successors, f"{lane.id} is a dead end"
        for successor in lane.successors:
            following = town.lanes[successor].centerline
            assert np.hypot(*(following[0] - lane.centerline[-1])) < 1e-6
            turn = wrap_angle(float(headings(following)[0] - headings(lane.centerline)[-1]))
            # Both are directions of chords: half a chord turns by up to 0.1 m over the radius.
            assert abs(turn) < 0.06


@pytest.mark.parametrize("name", TOWNS)
def test_centre_lines_are_dense(name: str) -> None:
    for lane in library.load(name).lanes.values():
        steps = np.diff(stations(lane.centerline))
        assert steps.min() > 0.0
        assert steps.max() <= 0.5 + 1e-9


@pytest.mark.parametrize("name", TOWNS)
def test_each_approach_of_a_junction_with_lights_leads_every_other_way(name: str) -> None:
    town = library.load(name)
    streets = Counter(light.junction for light in town.lights.values())
    for junction, num_streets in streets.items():
        moves = Counter(lane.move for lane in town.lanes.values() if lane.junction == junction)
        each = {3: 2, 4: 4}[num_streets]
        assert moves == {Move.LEFT: each, Move.STRAIGHT: each, Move.RIGHT: each}
    for light in town.lights.values():
        exits = [town.lanes[successor] for successor in town.lanes[light.lane].successors]
        assert {lane.junction for lane in exits} == {light.junction}
        assert len({lane.move for lane in exits}) == len(exits) == streets[light.junction] - 1


@pytest.mark.parametrize("name", TOWNS)
def test_junctions_without_lights_are_those_of_roundabouts(name: str) -> None:
    """One way in and one way out, both to the right, and one past them to the left."""
    town = library.load(name)
    lit = {light.junction for light in town.lights.values()}
    for junction in {lane.junction for lane in town.lanes.values()} - lit - {None}:
        moves = Counter(lane.move for lane in town.lanes.values() if lane.junction == junction)
        assert moves == {Move.LEFT: 1, Move.RIGHT: 2}


@pytest.mark.parametrize("name", TOWNS)
def test_each_lane_into_a_junction_with_lights_has_its_own(name: str) -> None:
    town = library.load(name)
    lit = {light.junction for light in town.lights.values()}
    approaches = {
        lane.id
        for lane in town.lanes.values()
        if any(town.lanes[successor].junction in lit for successor in lane.successors)
    }
    assert {light.lane for light in town.lights.values()} == approaches
    for light in town.lights.values():
        assert town.lanes[light.lane].light == light.id
    assert sum(lane.light is not None for lane in town.lanes.values()) == len(town.lights)


@pytest.mark.parametrize("name", TOWNS)
def test_stop_lines_cross_the_whole_lane_at_its_end(name: str) -> None:
    town = library.load(name)
    for light in town.lights.values():
        lane = town.lanes[light.lane]
        np.testing.assert_allclose(light.stop_line.mean(axis=0), lane.centerline[-1], atol=1e-9)
        across = light.stop_line[1] - light.stop_line[0]
        assert np.hypot(*across) == pytest.approx(lane.width)
        along = np.array([np.cos(light.yaw), np.sin(light.yaw)])
        assert along @ across == pytest.approx(0.0, abs=1e-9)
        assert along[0] * across[1] - along[1] * across[0] < 0.0, "expected left, then right"
        pole = light.pole - lane.centerline[-1]
        assert 2.2 < -(along[0] * pole[1] - along[1] * pole[0]) < 3.1, (
            "expected the pole right of the lane"
        )


def test_bounds_hold_every_lane_with_its_width(ladder: Town) -> None:
    np.testing.assert_allclose(ladder.bounds, [-4.0, -4.0, 124.0, 84.0], atol=1e-6)


def test_traffic_keeps_to_the_right(ladder: Town) -> None:
    np.testing.assert_allclose(
        ladder.lanes["1/0/-1"].centerline[[0, -1]], [[10.0, -2.0], [48.0, -2.0]], atol=1e-9
    )
    np.testing.assert_allclose(
        ladder.lanes["1/0/1"].centerline[[0, -1]], [[48.0, 2.0], [10.0, 2.0]], atol=1e-9
    )


def test_the_program_of_a_light_fills_its_cycle(ladder: Town) -> None:
    light = next(iter(ladder.lights.values()))
    assert light.program == ((Signal.GREEN, 10.0), (Signal.YELLOW, 3.0), (Signal.RED, 32.0))


def test_lanes_go_on_from_section_to_section(road_map: RoadMap) -> None:
    road = road_map.roads["3"]
    first = replace(
        road.sections[0],
        lanes=tuple(replace(lane, successor=lane.id) for lane in road.sections[0].lanes),
    )
    second = replace(
        road.sections[0],
        s=25.0,
        lanes=tuple(replace(lane, predecessor=lane.id) for lane in road.sections[0].lanes),
    )
    whole = _build(road_map)
    town = _build(
        replace(road_map, roads={**road_map.roads, "3": replace(road, sections=(first, second))})
    )
    assert town.lanes["3/0/-1"].successors == ("3/1/-1",)
    assert town.lanes["3/1/1"].successors == ("3/0/1",)
    assert town.lanes["3/1/-1"].successors == whole.lanes["3/0/-1"].successors


def test_lights_may_be_named_by_the_lanes_behind_them(road_map: RoadMap) -> None:
    """CARLA's maps name the connecting lanes, not the approach."""
    roads = dict(road_map.roads)
    (signal,) = roads["1"].signals
    roads["1"] = replace(roads["1"], signals=(replace(signal, from_lane=0, to_lane=0),))
    for road in road_map.roads.values():
        if road.junction == "20" and road.predecessor is not None and road.predecessor.id == "1":
            roads[road.id] = replace(road, references=(SignalReference(signal.id, -1, -1),))
    assert _build(replace(road_map, roads=roads)).lights[signal.id].lane == "1/0/-1"


def test_lanes_that_do_not_meet_are_built_as_they_are(road_map: RoadMap) -> None:
    """Maps of the real world are full of gaps; `check` names them."""
    road = road_map.roads["3"]
    (line,) = road.pieces
    moved = replace(road, pieces=(Piece(0.0, line.x + 0.02, line.y, line.heading, line.length),))
    town = _build(replace(road_map, roads={**road_map.roads, "3": moved}))
    gap = town.lanes["11/0/1"].centerline[0] - town.lanes["3/0/1"].centerline[-1]
    assert np.hypot(*gap) == pytest.approx(0.02)


def test_a_map_without_driving_lanes_is_refused(map_bytes: bytes) -> None:
    walkway = opendrive.parse(map_bytes.replace(b'"driving"', b'"sidewalk"'), source="test")
    with pytest.raises(TownFormatError, match="no driving lane"):
        _build(walkway)


def test_a_map_whose_lanes_have_no_width_is_refused(map_bytes: bytes) -> None:
    flat = re.sub(rb'(<width [^>]*?\ba=)"[^"]*"', rb'\1"0"', map_bytes)
    with pytest.raises(TownFormatError, match="only lanes that are 0 m wide"):
        _build(opendrive.parse(flat, source="test"))


@pytest.mark.parametrize("where", [1e8, 1e300])
def test_lanes_beyond_all_bounds_are_refused(road_map: RoadMap, where: float) -> None:
    road = road_map.roads["3"]
    moved = replace(road, pieces=(replace(road.pieces[0], x=where),))
    with pytest.raises(TownFormatError, match="Lane '3/0/1' runs beyond"):
        _build(replace(road_map, roads={**road_map.roads, "3": moved}))
