"""From an OpenDRIVE map to the lanes and lights of a `Town`."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Lane, Move, Signal, Town, TrafficLight
from mjdrive.errors import TownFormatError
from mjdrive.geometry import headings, wrap_angle
from mjdrive.town.lane_geometry import lane_centre, reference_line
from mjdrive.town.road_map import Road, RoadLink, RoadMap, SignalRecord
from mjdrive.town.settings import LightTiming

LARGEST_LANE_GAP = 0.01
"""Largest distance between the end of a lane and the start of its successor [m]."""

TRAFFIC_LIGHT_TYPE = "1000001"
"""OpenDRIVE signal type of a three-colour light."""

_STRAIGHT_BELOW = np.pi / 4
"""Largest change of heading of a straight move [rad]."""


class LaneKey(NamedTuple):
    """Where a lane is written in the map: road id, section index and lane number."""

    road: str
    section: int
    lane: int

    @property
    def name(self) -> str:
        """How a `Lane` is called."""
        return f"{self.road}/{self.section}/{self.lane}"


def build_town(road_map: RoadMap, *, name: str, timing: LightTiming, digest: str) -> Town:
    """Build the lanes and lights of a town; traffic keeps to the right.

    Args:
        road_map: The OpenDRIVE map.
        name: Name of the town.
        timing: How long the lights show each signal.
        digest: Digest of what the town is made from.

    Returns:
        The town.

    Raises:
        TownFormatError: If lanes do not meet or links lead nowhere.
    """
    lanes = _lanes(road_map)
    _require_lanes_to_meet(lanes)
    lights = _lights(road_map, lanes, timing)
    for light in lights.values():
        lanes[light.lane] = replace(lanes[light.lane], light=light.id)
    points = np.concatenate([lane.centerline for lane in lanes.values()])
    half_width = 0.5 * max(lane.width for lane in lanes.values())
    bounds = np.concatenate([points.min(axis=0) - half_width, points.max(axis=0) + half_width])
    return Town(name=name, lanes=lanes, lights=lights, bounds=bounds, digest=digest)


def _lanes(road_map: RoadMap) -> dict[str, Lane]:
    lanes = {}
    for road in road_map.roads.values():
        for index, section in enumerate(road.sections):
            for record in section.lanes:
                if record.type == "driving":
                    lane = _lane(road_map, road, LaneKey(road.id, index, record.id))
                    lanes[lane.id] = lane
    if not lanes:
        raise TownFormatError(
            f"Map '{road_map.name}' has no driving lane; expected lanes of type 'driving'."
        )
    return lanes


def _lane(road_map: RoadMap, road: Road, key: LaneKey) -> Lane:
    points, width = lane_centre(road, key.section, key.lane)
    if key.lane > 0:
        points = points[::-1]
    yaw = headings(points)
    turn = wrap_angle(float(yaw[-1] - yaw[0]))
    move = Move.FOLLOW
    if road.junction is not None:
        move = (
            Move.STRAIGHT if abs(turn) < _STRAIGHT_BELOW else Move.LEFT if turn > 0 else Move.RIGHT
        )
    return Lane(
        id=key.name,
        centerline=points,
        width=float(width.mean()),
        successors=tuple(following.name for following in _successors(road_map, road, key)),
        junction=road.junction,
        light=None,
        move=move,
    )


def _successors(road_map: RoadMap, road: Road, key: LaneKey) -> list[LaneKey]:
    """Find the driving lanes that follow a lane: in its road, on the next road or across a junction."""
    forward = key.lane < 0
    section = key.section + (1 if forward else -1)
    record = next(lane for lane in road.sections[key.section].lanes if lane.id == key.lane)
    linked = record.successor if forward else record.predecessor
    if 0 <= section < len(road.sections):
        found = [] if linked is None else [LaneKey(road.id, section, linked)]
        return _driving(road_map, found)
    link = road.successor if forward else road.predecessor
    if link is None:
        return []
    if link.kind == "junction":
        return _driving(road_map, _connections(road_map, road, key, link))
    if linked is None:
        return []
    return _driving(road_map, [_at_contact(road_map, link.id, link.contact or "start", linked)])


def _connections(road_map: RoadMap, road: Road, key: LaneKey, link: RoadLink) -> list[LaneKey]:
    junction = road_map.junctions.get(link.id)
    if junction is None:
        raise TownFormatError(
            f"Road '{road.id}' leads to junction '{link.id}', which the map does not have."
        )
    return [
        _at_contact(road_map, connection.connecting, connection.contact, there)
        for connection in junction.connections
        if connection.incoming == road.id
        for here, there in connection.lane_links
        # A lane that leads out of the junction may be linked too: only lanes entered at their start follow.
        if here == key.lane and (there < 0) == (connection.contact == "start")
    ]


def _at_contact(road_map: RoadMap, road_id: str, contact: str, lane: int) -> LaneKey:
    if road_id not in road_map.roads:
        raise TownFormatError(f"A link leads to road '{road_id}', which the map does not have.")
    last = len(road_map.roads[road_id].sections) - 1
    return LaneKey(road_id, 0 if contact == "start" else last, lane)


def _driving(road_map: RoadMap, keys: list[LaneKey]) -> list[LaneKey]:
    def is_driving(key: LaneKey) -> bool:
        lanes = road_map.roads[key.road].sections[key.section].lanes
        return any(lane.id == key.lane and lane.type == "driving" for lane in lanes)

    return [key for key in dict.fromkeys(keys) if is_driving(key)]


def _require_lanes_to_meet(lanes: Mapping[str, Lane]) -> None:
    for lane in lanes.values():
        for name in lane.successors:
            gap = float(np.hypot(*(lanes[name].centerline[0] - lane.centerline[-1])))
            if gap > LARGEST_LANE_GAP:
                raise TownFormatError(
                    f"Lane '{lane.id}' ends {gap:.3f} m from the start of its successor '{name}'; expected at "
                    f"most {LARGEST_LANE_GAP} m. Mend the road geometry or the link in the map."
                )


def _lights(
    road_map: RoadMap, lanes: Mapping[str, Lane], timing: LightTiming
) -> dict[str, TrafficLight]:
    """Give each approach its light and each controller of a junction its turn."""
    approaches = _approaches(road_map, lanes)
    signals = {
        signal.id: (road, signal)
        for road in road_map.roads.values()
        for signal in road.signals
        if signal.type == TRAFFIC_LIGHT_TYPE
    }
    lights = {}
    for junction in road_map.junctions.values():
        cycle = timing.turn * len(junction.controllers)
        for turn, controller in enumerate(junction.controllers):
            for signal_id in road_map.controllers.get(controller, ()):
                if signal_id not in signals:
                    raise TownFormatError(
                        f"Controller '{controller}' switches signal '{signal_id}'; the map has no light of that id."
                    )
                road, signal = signals[signal_id]
                light = _light(road, signal, lanes, approaches[signal_id], junction.id)
                program = (
                    (Signal.GREEN, timing.green),
                    (Signal.YELLOW, timing.yellow),
                    (Signal.RED, cycle - timing.green - timing.yellow),
                )
                offset = (cycle - turn * timing.turn) % cycle
                lights[light.id] = replace(light, program=program, offset=offset)
    return lights


def _approaches(road_map: RoadMap, lanes: Mapping[str, Lane]) -> dict[str, list[str]]:
    """Find the lanes that each signal stops: those it names itself, and those before the ones that refer to it."""
    before = defaultdict(list)
    for lane in lanes.values():
        for name in lane.successors:
            before[name].append(lane.id)
    approaches: dict[str, list[str]] = defaultdict(list)
    for road in road_map.roads.values():
        last = len(road.sections) - 1
        for signal in road.signals:
            for number in range(signal.from_lane, signal.to_lane + 1):
                name = LaneKey(road.id, last if number < 0 else 0, number).name
                if name in lanes and road.junction is None:
                    approaches[signal.id].append(name)
        for reference in road.references:
            for number in range(reference.from_lane, reference.to_lane + 1):
                name = LaneKey(road.id, 0 if number < 0 else last, number).name
                approaches[reference.id].extend(before[name])
    return defaultdict(list, {key: list(dict.fromkeys(names)) for key, names in approaches.items()})


def _light(
    road: Road,
    signal: SignalRecord,
    lanes: Mapping[str, Lane],
    approaches: list[str],
    junction: str,
) -> TrafficLight:
    if len(approaches) != 1:
        raise TownFormatError(
            f"Light '{signal.id}' beside road '{road.id}' stops the lanes {approaches}; expected exactly one lane "
            "that leads into a junction. Check its <validity>."
        )
    lane = lanes[approaches[0]]
    yaw = float(headings(lane.centerline)[-1])
    left = 0.5 * lane.width * np.array([-np.sin(yaw), np.cos(yaw)])
    point, heading = reference_line(road.pieces, np.array([signal.s]))
    pole = point[0] + signal.t * np.array([-np.sin(heading[0]), np.cos(heading[0])])
    return TrafficLight(
        id=signal.id,
        lane=lane.id,
        junction=junction,
        stop_line=np.stack([lane.centerline[-1] + left, lane.centerline[-1] - left]),
        yaw=yaw,
        pole=pole,
        program=(),
        offset=0.0,
    )
