"""From the signals and controllers of an OpenDRIVE map to traffic lights and their programs."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mjdrive.datatypes import Lane, Signal, TrafficLight
from mjdrive.errors import TownFormatError
from mjdrive.geometry import headings
from mjdrive.town.links import LaneKey, Links
from mjdrive.town.opendrive.reference_line import places_beside
from mjdrive.town.opendrive.road_map import Road, RoadMap, SignalRecord
from mjdrive.town.opendrive.vocabulary import LIGHT_TYPES
from mjdrive.town.settings import LightTiming
from mjdrive.town.stopped_lanes import stopped_lanes


@dataclass(frozen=True, slots=True)
class _Turn:
    """Signals of a junction that show green together."""

    junction: str
    signals: list[str]


def light_signals(road_map: RoadMap) -> dict[str, tuple[Road, SignalRecord]]:
    """Find the traffic lights for cars of a map, by id, and the roads that they stand beside."""
    return {
        signal.id: (road, signal)
        for road in road_map.roads.values()
        for signal in road.signals
        if signal.type in LIGHT_TYPES
    }


def build_lights(
    road_map: RoadMap, links: Links, lanes: Mapping[str, Lane], timing: LightTiming
) -> dict[str, TrafficLight]:
    """Give each lane that a signal stops its light, and each light its turn in the cycle of its junction.

    Signals of one controller take their turn together, in the order of the junction; controllers that no junction
    lists come after them, and signals without a controller take one turn for each road that they stop. Signals that
    stop a lane in common always take the same turn: a lane has one colour.

    Args:
        road_map: The OpenDRIVE map.
        links: The driven lanes of the map.
        lanes: The same lanes as they are called in the town.
        timing: How long the lights show each signal.

    Returns:
        The lights by name; a signal that stops no lane into a junction is none.

    Raises:
        TownFormatError: If a controller or reference names a signal, or a junction a controller, that is not there.
    """
    _require_references(road_map)
    signals = light_signals(road_map)
    stopped = stopped_lanes(road_map, links, signals)
    places = [(road, signal.s, signal.t) for road, signal in (signals[name] for name in stopped)]
    poles = dict(zip(stopped, places_beside(places)[0], strict=True))
    lights = {}
    for turns in _turns(road_map, stopped).values():
        cycle = timing.turn * len(turns)
        program = (
            (Signal.GREEN, timing.green),
            (Signal.YELLOW, timing.yellow),
            (Signal.RED, cycle - timing.green - timing.yellow),
        )
        for index, turn in enumerate(turns):
            offset = (cycle - index * timing.turn) % cycle
            for signal_id in turn.signals:
                keys = stopped[signal_id]
                for key in keys:
                    light = _light(
                        signal_id if len(keys) == 1 else f"{signal_id}/{key.name}",
                        lanes[key.name],
                        junction=turn.junction,
                        pole=poles[signal_id],
                        program=program,
                        offset=offset,
                        signal=signal_id,
                    )
                    lights[light.id] = light
    return lights


def _require_references(road_map: RoadMap) -> None:
    """Refuse names of signals and controllers that the map does not have."""
    known = {signal.id for road in road_map.roads.values() for signal in road.signals}
    for controller, signals in road_map.controllers.items():
        for signal in signals:
            if signal not in known:
                raise TownFormatError(
                    f"Controller '{controller}' switches signal '{signal}', which the map does not have."
                )
    for road in road_map.roads.values():
        for reference in road.references:
            if reference.id not in known:
                raise TownFormatError(
                    f"Road '{road.id}' refers to signal '{reference.id}', which the map does not have."
                )
    for junction in road_map.junctions.values():
        for controller in junction.controllers:
            if controller not in road_map.controllers:
                raise TownFormatError(
                    f"Junction '{junction.id}' lists controller '{controller}', which the map does not have."
                )


def _turns(
    road_map: RoadMap, stopped: Mapping[str, Mapping[LaneKey, str]]
) -> dict[str, list[_Turn]]:
    """Group the signals that stop lanes into the turns of each junction."""
    turns: dict[str, list[_Turn]] = defaultdict(list)
    turn_of_lane: dict[LaneKey, _Turn] = {}
    placed: set[str] = set()
    for junction, group in _groups(road_map, stopped):
        turn = _Turn(junction, [])
        for signal in group:
            if signal in placed or signal not in stopped:
                continue
            placed.add(signal)
            shared = [turn_of_lane[lane] for lane in stopped[signal] if lane in turn_of_lane]
            own = shared[0] if shared else turn
            own.signals.append(signal)
            for lane in stopped[signal]:
                turn_of_lane.setdefault(lane, own)
        if turn.signals:
            turns[junction].append(turn)
    return turns


def _groups(
    road_map: RoadMap, stopped: Mapping[str, Mapping[LaneKey, str]]
) -> Iterator[tuple[str, Sequence[str]]]:
    """List junctions and signals that belong together: by listed controller, by other controller, by road."""
    listed = set()
    for junction in road_map.junctions.values():
        for controller in junction.controllers:
            listed.add(controller)
            yield junction.id, road_map.controllers[controller]
    for controller, switched in road_map.controllers.items():
        if controller not in listed:
            yield from _by_junction(switched, stopped).items()
    roads: dict[str, list[str]] = defaultdict(list)
    for signal, lanes in stopped.items():
        roads[next(iter(lanes)).road].append(signal)
    for beside in roads.values():
        yield from _by_junction(beside, stopped).items()


def _by_junction(
    signals: Sequence[str], stopped: Mapping[str, Mapping[LaneKey, str]]
) -> dict[str, list[str]]:
    """Sort signals by the junction that the first of their lanes leads into."""
    found: dict[str, list[str]] = defaultdict(list)
    for signal in signals:
        if signal in stopped:
            found[next(iter(stopped[signal].values()))].append(signal)
    return found


def _light(
    light_id: str,
    lane: Lane,
    *,
    junction: str,
    pole: np.ndarray,
    program: tuple[tuple[Signal, float], ...],
    offset: float,
    signal: str,
) -> TrafficLight:
    """Draw the stop line across the end of a lane."""
    yaw = float(headings(lane.centerline)[-1])
    width = lane.width if lane.widths is None else float(lane.widths[-1])
    left = 0.5 * width * np.array([-np.sin(yaw), np.cos(yaw)])
    return TrafficLight(
        id=light_id,
        lane=lane.id,
        junction=junction,
        stop_line=np.stack([lane.centerline[-1] + left, lane.centerline[-1] - left]),
        yaw=yaw,
        pole=pole,
        program=program,
        offset=offset,
        signal=signal,
    )
