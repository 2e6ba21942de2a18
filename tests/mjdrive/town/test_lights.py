from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mjdrive.datatypes import Signal, Town
from mjdrive.errors import TownFormatError
from mjdrive.town import signals
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap, SignalRecord, SignalReference
from mjdrive.town.settings import LightTiming


def _build(road_map: RoadMap) -> Town:
    return build_town(road_map, name="small", timing=LightTiming(), digest="")


def _signal(name: str, lanes: tuple[int, int] = (0, 0), **more: Any) -> SignalRecord:
    facts = {"type": "1000001", "s": 48.0, "t": -9.0, "orientation": "+", **more}
    return SignalRecord(id=name, name="", from_lane=lanes[0], to_lane=lanes[1], **facts)


@pytest.fixture
def crossing(maker: Any) -> RoadMap:
    """Four arms of two lanes each way meet; each goes straight on. Signals "0" to "3" stand at the arms."""
    roads, ways = [], []
    for arm in range(4):
        cos, sin = (1, 0, -1, 0)[arm], (0, 1, 0, -1)[arm]
        far, near = (70.0 * cos, 70.0 * sin), (20.0 * cos, 20.0 * sin)
        roads.append(
            maker.road(
                str(arm),
                (far, near),
                maker.section(2, 1, -1, -2),
                links=("", "junction:J"),
                signals=(_signal(f"s{arm}", (-2, -1)),),
            )
        )
        across = maker.section(*(maker.lane(lane, successor=-lane) for lane in (-1, -2)))
        roads.append(
            maker.road(
                f"x{arm}",
                (near, (-near[0], -near[1])),
                across,
                links=(f"{arm}:end", f"{(arm + 2) % 4}:end"),
                junction="J",
            )
        )
        ways.append((str(arm), f"x{arm}", "start", (-1, -1), (-2, -2)))
    return maker.map(roads, [maker.junction("J", *ways)])


def _with_signals(road_map: RoadMap, road: str, *records: SignalRecord) -> RoadMap:
    changed = replace(road_map.roads[road], signals=records)
    return replace(road_map, roads={**road_map.roads, road: changed})


def _green(town: Town, time: float) -> set[str]:
    shown = signals.all_at(town, time)
    return {town.lights[name].signal for name, signal in shown.items() if signal is Signal.GREEN}


def test_a_signal_of_two_lanes_is_two_lights_that_share_it(crossing: RoadMap) -> None:
    town = _build(crossing)
    assert set(town.lights) == {f"s{arm}/{arm}/0/{lane}" for arm in range(4) for lane in (-1, -2)}
    near, far = town.lights["s0/0/0/-1"], town.lights["s0/0/0/-2"]
    assert (near.lane, far.lane) == ("0/0/-1", "0/0/-2")
    assert (near.signal, near.program, near.offset) == ("s0", far.program, far.offset)
    np.testing.assert_array_equal(near.pole, far.pole)
    np.testing.assert_allclose(near.stop_line, [[20.0, 0.0], [20.0, 3.5]], atol=1e-9)
    np.testing.assert_allclose(far.stop_line, [[20.0, 3.5], [20.0, 7.0]], atol=1e-9)
    assert {light.junction for light in town.lights.values()} == {"J"}
    assert all(town.lanes[light.lane].light == light.id for light in town.lights.values())


def test_without_controllers_each_road_has_its_turn(crossing: RoadMap) -> None:
    town = _build(crossing)
    assert [_green(town, 15.0 * turn + 1.0) for turn in range(4)] == [
        {"s0"},
        {"s1"},
        {"s2"},
        {"s3"},
    ]
    assert {signals.duration(light) for light in town.lights.values()} == {60.0}


def test_a_controller_gives_green_to_all_its_signals_at_once(crossing: RoadMap) -> None:
    controllers = {"a": ("s1", "s3"), "b": ("s0", "s2")}
    junction = replace(crossing.junctions["J"], controllers=("a", "b"))
    town = _build(replace(crossing, controllers=controllers, junctions={"J": junction}))
    assert [_green(town, 15.0 * turn + 1.0) for turn in range(2)] == [{"s1", "s3"}, {"s0", "s2"}]
    assert {signals.duration(light) for light in town.lights.values()} == {30.0}


def test_controllers_that_no_junction_lists_come_after_those_listed(crossing: RoadMap) -> None:
    controllers = {"free": ("s0", "s2"), "listed": ("s1",)}
    junction = replace(crossing.junctions["J"], controllers=("listed",))
    town = _build(replace(crossing, controllers=controllers, junctions={"J": junction}))
    assert [_green(town, 15.0 * turn + 1.0) for turn in range(3)] == [{"s1"}, {"s0", "s2"}, {"s3"}]


def test_signals_that_stop_the_same_lane_show_the_same(crossing: RoadMap) -> None:
    road_map = _with_signals(
        crossing, "0", _signal("s0", (-2, -1)), _signal("again", (-1, -1), t=9.0)
    )
    controllers = {"a": ("s0",), "b": ("again",)}
    town = _build(replace(road_map, controllers=controllers))
    first, second = town.lights["s0/0/0/-1"], town.lights["again"]
    assert first.lane == second.lane == "0/0/-1"
    assert (first.program, first.offset) == (second.program, second.offset)
    assert town.lanes["0/0/-1"].light == "s0/0/0/-1"
    assert signals.duration(first) == 60.0, "four turns, not five"


def test_a_signal_that_names_no_lane_holds_for_its_direction(crossing: RoadMap) -> None:
    town = _build(_with_signals(crossing, "0", _signal("s0")))
    assert {light.lane for light in town.lights.values() if light.signal == "s0"} == {
        "0/0/-1",
        "0/0/-2",
    }


def test_a_signal_is_found_by_the_lanes_behind_it(crossing: RoadMap) -> None:
    """CARLA's way: the signal names no lane, and a lane across the junction refers to it."""
    road_map = _with_signals(crossing, "0", _signal("s0"))
    across = replace(road_map.roads["x0"], references=(SignalReference("s0", -2, -2),))
    town = _build(replace(road_map, roads={**road_map.roads, "x0": across}))
    assert town.lights["s0"].lane == "0/0/-2"
    assert town.lanes["0/0/-1"].light is None


def test_a_signal_may_stand_on_another_road_than_the_one_it_stops(crossing: RoadMap) -> None:
    road_map = _with_signals(crossing, "0")
    road_map = _with_signals(road_map, "2", _signal("far side"))
    approach = replace(road_map.roads["0"], references=(SignalReference("far side", -1, -1, 48.0),))
    town = _build(replace(road_map, roads={**road_map.roads, "0": approach}))
    assert town.lights["far side"].lane == "0/0/-1"
    np.testing.assert_allclose(town.lights["far side"].pole, [-22.0, -9.0], atol=1e-9)


def test_a_light_stops_the_lane_at_the_end_of_its_road(maker: Any) -> None:
    """The section that the signal stands in need not be the last one."""
    sections = (maker.section(-1), maker.section(-1, s=49.0))
    into = maker.road(
        "1",
        ((-50, 0), (0, 0)),
        *sections,
        links=("", "junction:J"),
        signals=(_signal("light", (-1, -1), s=45.0),),
    )
    across = maker.road(
        "2", ((0, 0), (20, 0)), maker.section(-1), links=("1:end", ""), junction="J"
    )
    road_map = maker.map([into, across], [maker.junction("J", ("1", "2", "start", (-1, -1)))])
    light = _build(road_map).lights["light"]
    assert light.lane == "1/1/-1"
    assert light.program == ((Signal.GREEN, 10.0), (Signal.YELLOW, 3.0), (Signal.RED, 2.0))


def test_lights_for_people_on_foot_are_none_for_cars(crossing: RoadMap) -> None:
    road_map = _with_signals(crossing, "0", _signal("s0", type="1000002"))
    assert "s0" not in {light.signal for light in _build(road_map).lights.values()}


@pytest.mark.parametrize(
    ("controllers", "listed", "referred", "complaint"),
    [
        ({"a": ("ghost",)}, (), "s0", "Controller 'a' switches signal 'ghost'"),
        ({}, ("a",), "s0", "Junction 'J' lists controller 'a'"),
        ({}, (), "ghost", "Road 'x0' refers to signal 'ghost'"),
    ],
)
def test_names_of_what_is_not_there_are_refused(
    crossing: RoadMap,
    controllers: dict[str, tuple[str, ...]],
    listed: tuple[str, ...],
    referred: str,
    complaint: str,
) -> None:
    across = replace(crossing.roads["x0"], references=(SignalReference(referred, -1, -1),))
    road_map = replace(
        crossing,
        roads={**crossing.roads, "x0": across},
        junctions={"J": replace(crossing.junctions["J"], controllers=listed)},
        controllers=controllers,
    )
    with pytest.raises(TownFormatError, match=complaint):
        _build(road_map)
