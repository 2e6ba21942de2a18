from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mjdrive.datatypes import Signal, Town
from mjdrive.town import library, opendrive, routing, surface
from mjdrive.town.check import Finding, FindingKind, Severity, check
from mjdrive.town.lane_index import LaneIndex
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.opendrive.road_shapes import Cubic
from mjdrive.town.settings import LightTiming


def _build(road_map: RoadMap) -> Town:
    return build_town(road_map, name="small", timing=LightTiming(), digest="")


def _found(road_map: RoadMap, kind: FindingKind) -> list[Finding]:
    return [finding for finding in check(_build(road_map), road_map) if finding.kind is kind]


@pytest.mark.parametrize("name", library.shipped_names())
def test_nothing_breaks_a_drive_in_our_towns(name: str) -> None:
    road_map = opendrive.read(library.folder_of(name) / library.MAP_FILE)
    found = check(library.load(name), road_map)
    assert {finding.kind for finding in found} <= {FindingKind.TIGHT_TURN}
    assert not any(finding.breaks_a_drive for finding in found)


def test_a_sound_town_without_tight_turns_has_no_findings(ladder: Town, road_map: RoadMap) -> None:
    assert check(ladder, road_map) == ()


def _street(maker: Any, *, gap: float = 0.0, kink: float = 0.0) -> RoadMap:
    """Two one-lane roads, one behind the other along x."""
    start = (50.0 + gap, 0.0)
    far = (start[0] + 40.0 * np.cos(kink), 40.0 * np.sin(kink))
    lane_offsets = (Cubic(0.0, 1.75),)
    first = maker.road(
        "1", ((0, 0), (50, 0)), maker.section(-1), links=("", "2:start"), lane_offsets=lane_offsets
    )
    second = maker.road(
        "2", (start, far), maker.section(-1), links=("1:end", ""), lane_offsets=lane_offsets
    )
    return maker.map([first, second])


def test_a_gap_is_measured(maker: Any) -> None:
    (finding,) = _found(_street(maker, gap=0.02), FindingKind.GAP)
    assert (finding.where, finding.severity) == ("1/0/-1", Severity.ERROR)
    assert "ends 0.020 m from the start of its successor '2/0/-1'" in finding.text
    assert _found(_street(maker, gap=0.009), FindingKind.GAP) == []


def test_a_kink_is_measured(maker: Any) -> None:
    (finding,) = _found(_street(maker, kink=np.deg2rad(-12.0)), FindingKind.KINK)
    assert (finding.where, finding.breaks_a_drive) == ("1/0/-1", False)
    assert "12 degrees" in finding.text
    assert _found(_street(maker, kink=np.deg2rad(4.0)), FindingKind.KINK) == []


def test_both_ends_of_a_street_that_leads_nowhere_are_found(maker: Any) -> None:
    found = check(_build(_street(maker)))
    assert [(finding.kind, finding.where) for finding in found] == [
        (FindingKind.DEAD_END, "2/0/-1"),
        (FindingKind.SHORT_DRIVES, "small"),
        (FindingKind.UNREACHED, "1/0/-1"),
    ]
    assert found[0].breaks_a_drive
    assert not found[1].breaks_a_drive
    assert "after 90 m at most" in found[1].text


def test_a_lane_that_ends_beside_one_that_goes_on_is_no_error(maker: Any) -> None:
    first = [maker.lane(-2, successor=None), maker.lane(-3, successor=None)]
    sections = (maker.section(-1, *first), maker.section(-1, -2, s=30.0))
    road_map = maker.map([maker.road("1", ((0, 0), (50, 0)), *sections)])
    assert {f.where: f.severity for f in _found(road_map, FindingKind.DEAD_END)} == {
        "1/0/-2": Severity.WARNING,
        "1/0/-3": Severity.WARNING,
        "1/1/-1": Severity.ERROR,
        "1/1/-2": Severity.ERROR,
    }
    assert {f.where: f.severity for f in _found(road_map, FindingKind.UNREACHED)} == {
        "1/0/-1": Severity.WARNING,
        "1/0/-2": Severity.WARNING,
        "1/0/-3": Severity.WARNING,
        "1/1/-2": Severity.NOTE,
    }


def test_lanes_too_narrow_for_the_car_are_found(maker: Any) -> None:
    taper = maker.lane(-2, widths=(Cubic(0.0, 0.0, 0.07),))
    section = maker.section(maker.lane(1, width=1.7), maker.lane(-1, width=1.9), taper)
    found = _found(maker.map([maker.road("1", ((0, 0), (50, 0)), section)]), FindingKind.NARROW)
    assert {finding.where: finding.severity for finding in found} == {
        "1/0/1": Severity.WARNING,
        "1/0/-2": Severity.NOTE,
    }


@pytest.mark.parametrize(("radius", "is_tight"), [(3.3, True), (3.7, False)])
def test_turns_tighter_than_the_car_are_noted(maker: Any, radius: float, is_tight: bool) -> None:
    ring = maker.ring("1", radius, (0.0, 3.0), lane_offsets=(Cubic(0.0, 1.75),))
    found = _found(maker.map([ring]), FindingKind.TIGHT_TURN)
    assert len(found) == is_tight
    for finding in found:
        assert f"radius of {radius} m" in finding.text
        assert finding.severity is Severity.NOTE


def test_a_light_that_stops_no_lane_is_found(road_map: RoadMap) -> None:
    (signal,) = road_map.roads["1"].signals
    stray = replace(signal, id="stray", from_lane=-5, to_lane=-5)
    road = replace(road_map.roads["1"], signals=(signal, stray))
    changed = replace(road_map, roads={**road_map.roads, "1": road})
    (finding,) = check(_build(changed), changed)
    assert (finding.kind, finding.where) == (FindingKind.IDLE_LIGHT, "stray")
    assert finding.breaks_a_drive


def test_a_light_that_never_turns_green_is_found(ladder: Town) -> None:
    light = next(iter(ladder.lights.values()))
    red = replace(light, program=((Signal.GREEN, 0.0), (Signal.YELLOW, 3.0), (Signal.RED, 27.0)))
    (finding,) = check(replace(ladder, lights={**ladder.lights, light.id: red}))
    assert (finding.kind, finding.where) == (FindingKind.NEVER_GREEN, light.id)
    assert finding.text.startswith("It shows green 0 s, yellow 3 s, red 27 s: nobody ever passes")
    assert finding.breaks_a_drive


def test_stop_lines_that_cross_are_found(ladder: Town) -> None:
    first, second = list(ladder.lights.values())[:2]
    middle = first.stop_line.mean(axis=0)
    along = np.array([np.cos(first.yaw), np.sin(first.yaw)])
    across = replace(second, stop_line=np.stack([middle - along, middle + along]))
    town = replace(ladder, lights={**ladder.lights, second.id: across})
    (finding,) = check(town)
    assert finding.kind is FindingKind.CROSSED_STOP_LINES
    assert {finding.where} | {name for name in ladder.lights if f"'{name}'" in finding.text} == {
        first.id,
        second.id,
    }


def test_a_circle_apart_from_the_rest_is_an_island(maker: Any, road_map: RoadMap) -> None:
    small = maker.ring("99", 10.0, (0.0, 2.0 * np.pi), links=("99:end", "99:start"))
    town = _build(replace(road_map, roads={**road_map.roads, "99": small}))
    (finding,) = check(town)
    assert (finding.kind, finding.where) == (FindingKind.ISLAND, "99/0/-1")
    assert "1 lanes, 74 m" in finding.text


def test_the_worst_comes_first(roundabout_map: RoadMap) -> None:
    found = check(_build(roundabout_map), roundabout_map)
    kinds = Counter(finding.kind for finding in found)
    assert kinds[FindingKind.DEAD_END] == kinds[FindingKind.UNREACHED] == 2
    assert kinds[FindingKind.KINK] == 8, "the ways in and out are straight"
    severities = [finding.severity for finding in found]
    assert severities == sorted(severities, reverse=True)


TURNTABLE = b"""<OpenDRIVE><header revMajor="1" revMinor="4"/><road id="1" length="6" junction="-1">
<planView><geometry s="0" x="0" y="0" hdg="0" length="6"><arc curvature="0.5"/></geometry></planView>
<lanes><laneSection s="0"><left><lane id="1" type="driving"><width sOffset="0" a="4" b="0" c="0" d="0"/></lane></left>
<center><lane id="0" type="none"/></center></laneSection></lanes></road></OpenDRIVE>"""
"""A lane of 4 m inside a bend of 2 m: its middle stays at the centre."""


def test_a_lane_at_the_centre_of_its_bend_is_found_and_troubles_nobody() -> None:
    town = _build(opendrive.parse(TURNTABLE, source="turntable"))
    (finding,) = (f for f in check(town) if f.kind is FindingKind.NO_LENGTH)
    assert (finding.where, finding.severity) == ("1/0/1", Severity.ERROR)
    assert surface.lane_polygons(town)["1/0/1"].is_empty
    (place,) = LaneIndex(town).near(3.0, 2.0)
    assert abs(place.offset) == pytest.approx(3.0)
    name, seen = routing.nearest_lane(town, np.array([0.0, 5.0]))
    assert (name, abs(seen.offset)) == ("1/0/1", pytest.approx(3.0))
