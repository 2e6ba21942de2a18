"""An OpenDRIVE map as mjdrive and as CARLA read it, in the same words, so that the two can be compared.

CARLA's reading needs the package `carla` from PyPI and no server. Its y axis points south; all points here are in
OpenDRIVE coordinates. Lanes are called "road/section/lane" in both.
"""

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import carla
import numpy as np

from mjdrive.town import opendrive
from mjdrive.town.links import LaneKey
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.vocabulary import TRAFFIC_LIGHT_TYPE
from mjdrive.town.settings import LightTiming

SPACING = 0.1
"""Distance between waypoints that CARLA is asked for [m]."""

_SHORT = 0.01
"""A step over the end of a lane [m]."""


@dataclass(frozen=True)
class Reading:
    """What a reader made of a map.

    Attributes:
        lanes: Centre line of each driving lane in its direction of travel, both ends included, shape (N, 2) [m].
        followings: Pairs of lanes, of which the second follows the first.
        moves: Junction, lane before it and lane behind it, for each way across.
        stops: Where each light stops each lane, by light and lane, shape (2,) [m].
        junctions: Names of the junctions.
    """

    lanes: dict[str, np.ndarray]
    followings: frozenset[tuple[str, str]]
    moves: frozenset[tuple[str, str, str]]
    stops: dict[tuple[str, str], np.ndarray]
    junctions: frozenset[str]

    @property
    def signals(self) -> set[str]:
        """Names of the lights that stop a lane."""
        return {signal for signal, _ in self.stops}


def read_with_mjdrive(path: Path) -> Reading:
    """Read a map with mjdrive; only lanes of type "driving" count, as for CARLA."""
    road_map = opendrive.read(path)
    town = build_town(road_map, name=path.stem, timing=LightTiming(), digest="")
    driving = {
        LaneKey(road.id, index, lane.id).name
        for road in road_map.roads.values()
        for index, section in enumerate(road.sections)
        for lane in section.lanes
        if lane.type == "driving"
    }
    lanes = {name: lane for name, lane in town.lanes.items() if name in driving}
    followings = frozenset(
        (name, following)
        for name, lane in lanes.items()
        for following in lane.successors
        if following in driving
    )
    across = {name: lane.junction for name, lane in lanes.items() if lane.junction is not None}
    return Reading(
        lanes={name: lane.centerline for name, lane in lanes.items()},
        followings=followings,
        moves=_moves(followings, across),
        stops={
            (light.signal, light.lane): light.stop_line.mean(axis=0)
            for light in town.lights.values()
            if light.lane in driving
        },
        junctions=frozenset(across.values()),
    )


def read_with_carla(path: Path) -> Reading:
    """Read a map with CARLA's own client library.

    Raises:
        RuntimeError: If CARLA does not accept the map.
        IndexError: If CARLA does not understand a link, as those of direct junctions.
    """
    carla_map = carla.Map(path.stem, path.read_text())
    found: dict[str, list[Any]] = defaultdict(list)
    for waypoint in carla_map.generate_waypoints(SPACING):
        found[_name(waypoint)].append(waypoint)
    lanes = {name: _in_travel(carla_map, waypoints) for name, waypoints in found.items()}
    pairs = [(first, second) for first, second in carla_map.get_topology()]
    # What the topology lists, and what a step over the end of each lane meets. Both name other types of lanes too,
    # and now and then the lane itself.
    pairs += [(lane[-1], ahead) for lane in lanes.values() for ahead in lane[-1].next(_SHORT)]
    followings = frozenset(
        (_name(first), _name(second))
        for first, second in pairs
        if {_name(first), _name(second)} <= lanes.keys() and _name(first) != _name(second)
    )
    across = {
        name: str(lane[0].get_junction().id) for name, lane in lanes.items() if lane[0].is_junction
    }
    return Reading(
        lanes={name: np.stack([_point(w) for w in lane]) for name, lane in lanes.items()},
        followings=followings,
        moves=_moves(followings, across),
        stops=_stops(carla_map, lanes, followings, across),
        junctions=frozenset(across.values()),
    )


def _moves(
    followings: frozenset[tuple[str, str]], across: dict[str, str]
) -> frozenset[tuple[str, str, str]]:
    """Join what leads to each lane across a junction and what follows it."""
    before, behind = defaultdict(list), defaultdict(list)
    for first, second in followings:
        behind[first].append(second)
        before[second].append(first)
    return frozenset(
        (junction, first, last)
        for name, junction in across.items()
        for first in before[name]
        for last in behind[name]
    )


def _stops(
    carla_map: Any,
    lanes: dict[str, list[Any]],
    followings: frozenset[tuple[str, str]],
    across: dict[str, str],
) -> dict[tuple[str, str], np.ndarray]:
    """Find where approach lanes meet the junction: CARLA names them, or the lanes across that lie behind a light."""
    numbered: dict[tuple[str, int], list[str]] = defaultdict(list)
    for name in lanes:
        road, _, lane = name.rsplit("/", 2)
        numbered[road, int(lane)].append(name)
    stops = {}
    for landmark in carla_map.get_all_landmarks_of_type(TRAFFIC_LIGHT_TYPE):
        for low, high in map(sorted, landmark.get_lane_validities()):
            for number in range(low, high + 1):
                for name in numbered[str(landmark.road_id), number]:
                    if name not in across:
                        stops[landmark.id, name] = _point(lanes[name][-1])
                        continue
                    for approach, entered in followings:
                        if entered == name and approach not in across:
                            stops[landmark.id, approach] = _point(lanes[name][0])
    return stops


def _in_travel(carla_map: Any, waypoints: list[Any]) -> list[Any]:
    """Put the waypoints of a lane in the order of travel, with one at each end."""
    ordered = sorted(waypoints, key=lambda waypoint: waypoint.s)
    ordered = [
        _farthest(carla_map, ordered[0], -1.0),
        *ordered,
        _farthest(carla_map, ordered[-1], 1.0),
    ]
    along = _point(ordered[2 if len(ordered) > 3 else -1]) - _point(ordered[0])
    yaw = -np.deg2rad(ordered[0].transform.rotation.yaw)
    is_along = along @ np.array([np.cos(yaw), np.sin(yaw)]) > 0.0
    return ordered if is_along else ordered[::-1]


def _farthest(carla_map: Any, waypoint: Any, side: float) -> Any:
    """Find the last waypoint of a lane along s (side 1) or against it (side -1), by halving."""
    last, step = waypoint, 2.0 * SPACING
    while step > 1e-7:
        s = max(last.s + side * step, 0.0)
        beyond = carla_map.get_waypoint_xodr(waypoint.road_id, waypoint.lane_id, s)
        if beyond is not None and beyond.section_id == waypoint.section_id:
            last = beyond
        step /= 2.0
    return last


def _point(waypoint: Any) -> np.ndarray:
    location = waypoint.transform.location
    return np.array([location.x, -location.y])


def _name(waypoint: Any) -> str:
    return f"{waypoint.road_id}/{waypoint.section_id}/{waypoint.lane_id}"
