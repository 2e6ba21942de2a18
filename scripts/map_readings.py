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
from mjdrive.town.lights import TRAFFIC_LIGHT_TYPE
from mjdrive.town.links import LaneKey
from mjdrive.town.network import build_town
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
    """
    carla_map = carla.Map(path.stem, path.read_text())
    starts: dict[str, Any] = {}
    followings = set()
    for start, following in carla_map.get_topology():
        if carla.LaneType.Driving == start.lane_type == following.lane_type:
            followings.add((_name(start), _name(following)))
            starts |= {_name(start): start, _name(following): following}
    waypoints: dict[str, list[Any]] = defaultdict(list)
    for waypoint in carla_map.generate_waypoints(SPACING):
        waypoints[_name(waypoint)].append(waypoint)
    for name, found in waypoints.items():
        starts.setdefault(name, found[0])
    ends = {name: start.next_until_lane_end(SPACING)[-1] for name, start in starts.items()}
    followings |= {
        (name, _name(waypoint))
        for name, end in ends.items()
        for waypoint in end.next(_SHORT)
        if waypoint.lane_type == carla.LaneType.Driving and _name(waypoint) != name
    }
    across = {
        name: str(start.get_junction().id) for name, start in starts.items() if start.is_junction
    }
    return Reading(
        lanes={name: _line(starts[name], waypoints[name], ends[name]) for name in starts},
        followings=frozenset(followings),
        moves=_moves(frozenset(followings), across),
        stops=_stops(carla_map, starts, ends, frozenset(followings), across),
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
    starts: dict[str, Any],
    ends: dict[str, Any],
    followings: frozenset[tuple[str, str]],
    across: dict[str, str],
) -> dict[tuple[str, str], np.ndarray]:
    """Find where approach lanes meet the junction: CARLA names them, or the lanes across that lie behind a light."""
    numbered: dict[tuple[str, int], list[str]] = defaultdict(list)
    for name in starts:
        road, _, lane = name.rsplit("/", 2)
        numbered[road, int(lane)].append(name)
    stops = {}
    for landmark in carla_map.get_all_landmarks_of_type(TRAFFIC_LIGHT_TYPE):
        for low, high in map(sorted, landmark.get_lane_validities()):
            for number in range(low, high + 1):
                for name in numbered[str(landmark.road_id), number]:
                    if name not in across:
                        stops[landmark.id, name] = _point(ends[name])
                        continue
                    for approach, entered in followings:
                        if entered == name and approach not in across:
                            stops[landmark.id, approach] = _point(starts[name])
    return stops


def _line(start: Any, between: list[Any], end: Any) -> np.ndarray:
    """Join the waypoints of a lane in its direction of travel."""
    ordered = sorted(between, key=lambda waypoint: waypoint.s, reverse=bool(start.s > end.s))
    return np.stack([_point(waypoint) for waypoint in (start, *ordered, end)])


def _point(waypoint: Any) -> np.ndarray:
    location = waypoint.transform.location
    return np.array([location.x, -location.y])


def _name(waypoint: Any) -> str:
    return f"{waypoint.road_id}/{waypoint.section_id}/{waypoint.lane_id}"
