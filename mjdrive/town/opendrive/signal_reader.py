"""Read traffic lights and signs, and the controllers that switch lights."""

from collections.abc import Sequence
from itertools import pairwise

from mjdrive.town.opendrive.road_map import LaneSection, SignalRecord, SignalReference
from mjdrive.town.opendrive.xml_fields import Element, XmlFields


def read_signals(
    fields: XmlFields,
    road: Element,
    length: float,
    sections: Sequence[LaneSection],
    *,
    drives_on_left: bool,
) -> tuple[SignalRecord, ...]:
    """Read the signals that stand beside a road.

    Args:
        fields: Takes values out of the document.
        road: The road.
        length: Its length [m].
        sections: Its lane sections.
        drives_on_left: Whether traffic keeps to the left.

    Returns:
        The signals.

    Raises:
        TownFormatError: If a value is missing or is no number.
    """
    signals = []
    for element in fields.each(road, "signals", "signal"):
        s, orientation, from_lane, to_lane = _read_hold(
            fields, element, length, sections, drives_on_left=drives_on_left
        )
        signals.append(
            SignalRecord(
                id=fields.text(element, "id"),
                name=fields.optional(element, "name"),
                type=fields.text(element, "type"),
                s=s,
                t=fields.number(element, "t"),
                orientation=orientation,
                from_lane=from_lane,
                to_lane=to_lane,
                dynamic=fields.optional(element, "dynamic") == "yes",
                value=fields.number(element, "value", -1.0),
                unit=fields.optional(element, "unit"),
            )
        )
    return tuple(signals)


def read_references(
    fields: XmlFields,
    road: Element,
    length: float,
    sections: Sequence[LaneSection],
    *,
    drives_on_left: bool,
) -> tuple[SignalReference, ...]:
    """Read where signals of other roads hold on a road.

    Args:
        fields: Takes values out of the document.
        road: The road.
        length: Its length [m].
        sections: Its lane sections.
        drives_on_left: Whether traffic keeps to the left.

    Returns:
        The references.

    Raises:
        TownFormatError: If a value is missing or is no number.
    """
    references = []
    for element in fields.each(road, "signals", "signalReference"):
        s, orientation, from_lane, to_lane = _read_hold(
            fields, element, length, sections, drives_on_left=drives_on_left
        )
        name = fields.text(element, "id")
        references.append(SignalReference(name, from_lane, to_lane, s, orientation))
    # Beside which lane the signal stands is said by the signal itself.
    fields.asked["signalReference"].add("t")
    return tuple(references)


def read_controller(fields: XmlFields, element: Element) -> tuple[str, ...]:
    """Read which signals a controller switches.

    Args:
        fields: Takes values out of the document.
        element: The controller.

    Returns:
        Ids of its signals, each once.

    Raises:
        TownFormatError: If an id is missing.
    """
    fields.asked["controller"].update(("name", "sequence"))
    fields.asked["control"].add("type")
    # RoadRunner lists a signal twice where two of its lanes turn.
    signals = (fields.text(control, "signalId") for control in fields.each(element, "control"))
    return tuple(dict.fromkeys(signals))


def read_station(fields: XmlFields, element: Element, length: float) -> float:
    """Read where something is along a road; what lies beyond an end counts as at the end.

    Args:
        fields: Takes values out of the document.
        element: The thing.
        length: Length of the road [m].

    Returns:
        Station along the road [m].

    Raises:
        TownFormatError: If it is missing or is no number.
    """
    s = fields.number(element, "s")
    if not -0.01 <= s <= length + 0.01:
        fields.note(f"{element.tag} beyond the end of its road; moved to the end")
    return min(max(s, 0.0), length)


def _read_hold(
    fields: XmlFields,
    element: Element,
    length: float,
    sections: Sequence[LaneSection],
    *,
    drives_on_left: bool,
) -> tuple[float, str, int, int]:
    """Read where along a road a signal holds [m], for which direction, and for which lanes."""
    s = read_station(fields, element, length)
    orientation = _read_orientation(fields, element)
    forward = _lanes_at(sections, s, orientation, drives_on_left=drives_on_left)
    return (s, orientation, *_read_validity(fields, element, sections, forward))


def _read_orientation(fields: XmlFields, element: Element) -> str:
    return fields.choice(element, "orientation", ("+", "-", "none"))


def _lanes_at(
    sections: Sequence[LaneSection], s: float, orientation: str, *, drives_on_left: bool
) -> tuple[int, int]:
    """Smallest and largest id of the lanes at a place whose traffic a signal is for; 0 and 0 if none."""
    section = next((section for section in reversed(sections) if section.s <= s), sections[0])
    lowest, highest = section.lanes[-1].id, section.lanes[0].id
    if orientation == "none":
        return lowest, highest
    is_right = (orientation == "+") != drives_on_left
    if is_right:
        return (lowest, -1) if lowest < 0 else (0, 0)
    return (1, highest) if highest > 0 else (0, 0)


def _read_validity(
    fields: XmlFields,
    element: Element,
    sections: Sequence[LaneSection],
    default: tuple[int, int],
) -> tuple[int, int]:
    """Smallest and largest lane id that a signal holds for, among the lanes that the road has."""
    spans = [
        sorted((fields.integer(e, "fromLane"), fields.integer(e, "toLane")))
        for e in fields.each(element, "validity")
    ]
    if not spans:
        return default
    spans.sort()
    if any(right[0] > left[1] + 1 for left, right in pairwise(spans)):
        fields.note("validity with lanes left out; those between count as well")
    lowest = min(section.lanes[-1].id for section in sections)
    highest = max(section.lanes[0].id for section in sections)
    from_lane, to_lane = max(spans[0][0], lowest), min(max(span[1] for span in spans), highest)
    if from_lane > to_lane:
        fields.note("validity for lanes that the road does not have")
        return 0, 0
    return from_lane, to_lane
