"""Which lanes the traffic lights of an OpenDRIVE map stop."""

from collections import defaultdict
from collections.abc import Container, Mapping
from dataclasses import dataclass

from mjdrive.town.links import LaneKey, Links
from mjdrive.town.opendrive.road_map import Road, RoadMap, SignalRecord, SignalReference

FARTHEST_BEFORE_JUNCTION = 50.0
"""A signal further before the end of its road guards something else than the junction there, a crossing say [m]."""


@dataclass(frozen=True, slots=True)
class _Hold:
    """A stretch of road where a signal is said to hold."""

    road: Road
    facts: SignalRecord | SignalReference

    @property
    def is_explicit(self) -> bool:
        """Whether the map names lanes; 0 to 0 names none."""
        return (self.facts.from_lane, self.facts.to_lane) != (0, 0)


def stopped_lanes(
    road_map: RoadMap, links: Links, signals: Container[str]
) -> dict[str, dict[LaneKey, str]]:
    """Find the lanes that end in front of a junction where a signal stops them.

    A map names the lanes of the approach, or those across the junction that lie behind the signal (as CARLA's maps
    do). Where it names no lane at all, the signal holds for every lane of its direction.

    Args:
        road_map: The OpenDRIVE map.
        links: The driven lanes of the map.
        signals: Ids of the signals to look at.

    Returns:
        By signal id, the junctions that the stopped lanes lead into, by lane. Signals that stop none are left out.
    """
    stopped: dict[str, dict[LaneKey, str]] = {}
    for signal, holds in _holds(road_map, signals).items():
        found: dict[LaneKey, str] = {}
        for hold in holds:
            for key in _approaches(hold, links):
                junction = _junction(road_map, key, links)
                if junction is not None:
                    found[key] = junction
        if found:
            stopped[signal] = found
    return stopped


def _holds(road_map: RoadMap, signals: Container[str]) -> dict[str, list[_Hold]]:
    """Collect where each signal holds: where lanes are named, else where it is referred to, else where it stands."""
    own: dict[str, list[_Hold]] = defaultdict(list)
    referred: dict[str, list[_Hold]] = defaultdict(list)
    for road in road_map.roads.values():
        for signal in road.signals:
            if signal.id in signals:
                own[signal.id].append(_Hold(road, signal))
        for reference in road.references:
            if reference.id in signals:
                referred[reference.id].append(_Hold(road, reference))
    return {
        name: [hold for hold in own[name] + referred[name] if hold.is_explicit]
        or referred[name]
        or own[name]
        for name in own
    }


def _held(hold: _Hold, links: Links) -> list[LaneKey]:
    """Find the driven lanes beside a signal that it holds for."""
    road, facts = hold.road, hold.facts
    section = max(
        (index for index, section in enumerate(road.sections) if section.s <= facts.s), default=0
    )
    keys = [
        key
        for record in road.sections[section].lanes
        if (key := LaneKey(road.id, section, record.id)) in links.following
        and (not hold.is_explicit or facts.from_lane <= record.id <= facts.to_lane)
    ]
    # Maps of CARLA turn the orientation round, so it decides only where the lanes leave it open.
    if facts.orientation in ("+", "-") and len({links.runs_along(key) for key in keys}) == 2:
        keys = [key for key in keys if links.runs_along(key) == (facts.orientation == "+")]
    if road.junction is None:
        keys = [
            key for key in keys if _distance_to_end(hold, links, key) <= FARTHEST_BEFORE_JUNCTION
        ]
    return keys


def _distance_to_end(hold: _Hold, links: Links, key: LaneKey) -> float:
    return hold.road.length - hold.facts.s if links.runs_along(key) else hold.facts.s


def _approaches(hold: _Hold, links: Links) -> list[LaneKey]:
    """Go from where a signal holds to the lanes that end at its stop line."""
    held = _held(hold, links)
    if hold.road.junction is None:
        return [_end_of_road(key, links.following) for key in held]
    return [lane for key in held for lane in links.before[_end_of_road(key, links.before)]]


def _end_of_road(key: LaneKey, onward: Mapping[LaneKey, list[LaneKey]]) -> LaneKey:
    """Follow a lane within its road."""
    passed = {key}
    while ahead := [lane for lane in onward[key] if lane.road == key.road and lane not in passed]:
        key = ahead[0]
        passed.add(key)
    return key


def _junction(road_map: RoadMap, key: LaneKey, links: Links) -> str | None:
    """Name the junction that a lane outside junctions leads into."""
    if road_map.roads[key.road].junction is not None:
        return None
    ahead = [road_map.roads[lane.road].junction for lane in links.following[key]]
    return next((name for name in ahead if name is not None), links.junction_behind(key))
