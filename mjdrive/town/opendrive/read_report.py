"""What a map held, and what of it mjdrive could not use."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from mjdrive.town.opendrive.flattening import Flattening
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.opendrive.vocabulary import (
    DRIVEN_LANE_TYPES,
    GROUND_LANE_TYPES,
    LIGHT_TYPES,
    OBJECT_TYPES,
    PAINTED_LINES,
    SIDEWALK_LANE_TYPES,
    SPEED_LIMIT_TYPE,
)
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

_UNDERSTOOD = {
    "lane": DRIVEN_LANE_TYPES | SIDEWALK_LANE_TYPES | GROUND_LANE_TYPES,
    "signal": LIGHT_TYPES | {SPEED_LIMIT_TYPE},
    "object": OBJECT_TYPES,
    "road mark": frozenset(PAINTED_LINES) | {"none", "curb"},
}
"""Types that mean something to mjdrive."""

_NAMES = frozenset({"id", "name"})
"""Attributes that only tell things apart; they are not missed."""

_WITHOUT_MEANING = frozenset({"", "none", "false", "no", "standard", "-1", "undefined"})
"""Values of attributes that say nothing; they are not missed either."""


@dataclass(frozen=True, slots=True)
class ReadReport:
    """What was read from a map.

    Attributes:
        source: File or name of the map.
        version: OpenDRIVE version, for example "1.4".
        roads: Number of roads [-].
        junctions: Number of junctions [-].
        length: Of all reference lines together [m].
        lanes: Number of lanes by type, counted once in each lane section.
        signals: Number of signals by type.
        objects: Number of objects by type.
        not_used: What the map says and mjdrive does not use, with counts: elements by their path
            ("road/railroad", with all that they hold), attributes ("road/signals/signal@zOffset") and values
            ("lane type 'tram'").
        flattened: How much height was ignored.
    """

    source: str
    version: str
    roads: int
    junctions: int
    length: float
    lanes: Mapping[str, int]
    signals: Mapping[str, int]
    objects: Mapping[str, int]
    not_used: Mapping[str, int]
    flattened: Flattening = field(default_factory=Flattening)


def make_report(
    root: Element, fields: XmlFields, version: str, road_map: RoadMap, flattened: Flattening
) -> ReadReport:
    """Report on a map that was read.

    Args:
        root: The document.
        fields: What the reader took out of it.
        version: OpenDRIVE version.
        road_map: What it made of it.
        flattened: How much height it ignored.

    Returns:
        The report.
    """
    types = _types(road_map)
    return ReadReport(
        source=fields.source,
        version=version,
        roads=len(road_map.roads),
        junctions=len(road_map.junctions),
        length=sum(road.length for road in road_map.roads.values()),
        lanes=_sorted(types["lane"]),
        signals=_sorted(types["signal"]),
        objects=_sorted(types["object"]),
        not_used=_sorted(_left_over(root, fields) + fields.notes + _without_meaning(types)),
        flattened=flattened,
    )


def _types(road_map: RoadMap) -> dict[str, Counter[str]]:
    """Count lanes, signals, objects and road marks by their types."""
    roads = road_map.roads.values()
    lanes = [lane for road in roads for section in road.sections for lane in section.lanes]
    return {
        "lane": Counter(lane.type for lane in lanes if lane.id != 0),
        "signal": Counter(signal.type for road in roads for signal in road.signals),
        "object": Counter(thing.type for road in roads for thing in road.objects),
        "road mark": Counter(mark.type for lane in lanes for mark in lane.marks),
    }


def _without_meaning(types: Mapping[str, Counter[str]]) -> Counter[str]:
    return Counter(
        {
            f"{kind} type '{name}'": count
            for kind, counts in types.items()
            for name, count in counts.items()
            if name not in _UNDERSTOOD[kind]
        }
    )


def _left_over(root: Element, fields: XmlFields) -> Counter[str]:
    """Count the elements and attributes that nothing was taken from."""
    found: Counter[str] = Counter()
    known = {tag: asked | _NAMES for tag, asked in fields.asked.items()}
    waiting = [(child, child.tag) for child in root.iterchildren("*")]
    while waiting:
        element, path = waiting.pop()
        if element not in fields.used:
            found[path] += 1
            continue
        asked = known.get(element.tag, _NAMES)
        for name, value in element.items():
            if name not in asked and _says_something(value):
                found[f"{path}@{name}"] += 1
        if len(element):
            waiting += [(child, f"{path}/{child.tag}") for child in element.iterchildren("*")]
    return found


def _says_something(value: str) -> bool:
    if value.strip().lower() in _WITHOUT_MEANING:
        return False
    try:
        return float(value) != 0.0
    except ValueError:
        return True


def _sorted(counts: Counter[str]) -> dict[str, int]:
    """Order by number, largest first, then by name."""
    return dict(sorted(counts.items(), key=lambda item: (-item[1], item[0])))
