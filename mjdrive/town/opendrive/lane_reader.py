"""Read the lanes of a road."""

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

from mjdrive.town.opendrive.cross_section import WIDEST_LANE
from mjdrive.town.opendrive.lane_sides import carry_over
from mjdrive.town.opendrive.road_map import LaneRecord, LaneSection
from mjdrive.town.opendrive.road_marks import read_marks
from mjdrive.town.opendrive.road_shapes import Cubic
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

_SIDES = {"left": 1, "center": 0, "right": -1}

_DIRECTIONS = ("standard", "reversed", "both")

_SHORTEST_SECTION = 1e-6
"""Shortest lane section [m]."""

_ALLOWED_DIP = 1e-3
"""How far a width may go below 0 without a note [m]."""


def read_lane_offsets(fields: XmlFields, road: Element) -> tuple[Cubic, ...]:
    """Read the shift of lane 0 from the reference line.

    Args:
        fields: Takes values out of the document.
        road: The road.

    Returns:
        The cubics in order.

    Raises:
        TownFormatError: If they are out of order.
    """
    return _read_cubics(fields, fields.each(road, "lanes", "laneOffset"), "s")


def read_sections(fields: XmlFields, road: Element, length: float) -> tuple[LaneSection, ...]:
    """Read the lane sections of a road.

    Args:
        fields: Takes values out of the document.
        road: The road.
        length: Its length [m].

    Returns:
        The sections in order; each holds the lanes of both sides.

    Raises:
        TownFormatError: If they are out of order, empty, number their lanes with gaps, or have a lane wider than
            `WIDEST_LANE`.
    """
    elements = fields.some(road, "lanes", "laneSection")
    sections: list[LaneSection] = []
    holders: list[Element] = []
    for element in elements:
        is_single = fields.optional(element, "singleSide").lower() in ("true", "1")
        section = _read_section(fields, element)
        if is_single and sections:
            carry_over(sections, section)
        else:
            sections.append(section)
        if len(sections) > len(holders):
            holders.append(element)
    if abs(sections[0].s) > _SHORTEST_SECTION:
        fields.fail(elements[0], f"starts at s={sections[0].s:g}; expected 0.")
    starts = [*(section.s for section in sections), length]
    if any(later - earlier <= _SHORTEST_SECTION for earlier, later in pairwise(starts)):
        fields.fail(
            elements[-1].getparent(),
            "has a lane section without length, out of order or behind the end of the road; expected rising s.",
        )
    for element, section, end in zip(holders, sections, starts[1:], strict=True):
        _check_widths(fields, element, section, end - section.s)
    return tuple(sections)


def _read_section(fields: XmlFields, element: Element) -> LaneSection:
    lanes = [
        _read_lane(fields, lane, sign)
        for side, sign in _SIDES.items()
        for lane in fields.each(element, side, "lane")
    ]
    lanes.sort(key=lambda lane: -lane.id)
    ids = [lane.id for lane in lanes]
    if 0 not in ids or ids != list(range(ids[0], ids[0] - len(ids), -1)):
        shown = ", ".join(map(str, ids[:20])) or "none"
        fields.fail(
            element, f"has lanes {shown}; expected whole numbers without a gap that include 0."
        )
    return LaneSection(fields.number(element, "s"), tuple(lanes))


def _read_lane(fields: XmlFields, element: Element, sign: int) -> LaneRecord:
    number = fields.integer(element, "id")
    if (number > 0) - (number < 0) != sign:
        fields.fail(
            element, f"has id='{number}'; expected positive on the left and negative on the right."
        )
    widths = _read_cubics(fields, fields.each(element, "width"), "sOffset")
    borders: tuple[Cubic, ...] = ()
    if not widths:
        # Where a lane has both, widths count, and the borders are reported as not used.
        borders = _read_cubics(fields, fields.each(element, "border"), "sOffset")
    if number and not (widths or borders):
        fields.fail(element, "has no <width> and no <border>; expected one of them.")
    direction = fields.optional(element, "direction", "standard")
    if direction not in _DIRECTIONS:
        fields.note(f"lane direction '{direction}'")
        direction = "standard"
    return LaneRecord(
        id=number,
        type=fields.text(element, "type"),
        widths=widths,
        predecessor=_read_lane_link(fields, element, "predecessor"),
        successor=_read_lane_link(fields, element, "successor"),
        marks=read_marks(fields, element),
        borders=borders,
        direction=direction,
    )


def _read_lane_link(fields: XmlFields, lane: Element, tag: str) -> int | None:
    link = fields.child(lane, "link", tag)
    return None if link is None else fields.integer(link, "id")


def _read_cubics(fields: XmlFields, elements: Iterable[Element], start: str) -> tuple[Cubic, ...]:
    cubics: list[Cubic] = []
    for element in elements:
        cubic = Cubic(*(fields.number(element, name) for name in (start, "a", "b", "c", "d")))
        if cubics and cubic.start < cubics[-1].start:
            fields.fail(
                element,
                f"starts at {cubic.start:g}, before the one above; expected rising {start}.",
            )
        cubics.append(cubic)
    return tuple(cubics)


def _check_widths(fields: XmlFields, element: Element, section: LaneSection, length: float) -> None:
    for lane in section.lanes:
        narrowest, widest = _range(lane.widths, length)
        if narrowest < -_ALLOWED_DIP:
            fields.note("lane with a negative width, which counts as 0")
        if lane.id and widest > WIDEST_LANE:
            fields.fail(
                element,
                f"has lane {lane.id} up to {widest:g} m wide; expected at most {WIDEST_LANE:g} m.",
            )


def _range(cubics: Sequence[Cubic], end: float) -> tuple[float, float]:
    """Smallest and largest value of cubics that follow each other, and 0 [m]."""
    stops = [*(cubic.start for cubic in cubics[1:]), end]
    values = [0.0]
    for cubic, stop in zip(cubics, stops, strict=False):
        span = min(stop, end) - cubic.start
        if span < 0.0:
            continue
        turns = _real_roots(3.0 * cubic.d, 2.0 * cubic.c, cubic.b)
        values += [
            cubic.a + ds * (cubic.b + ds * (cubic.c + ds * cubic.d))
            for ds in (0.0, span, *(turn for turn in turns if 0.0 < turn < span))
        ]
    return min(values), max(values)


def _real_roots(a: float, b: float, c: float) -> tuple[float, ...]:
    """Solve a x^2 + b x + c = 0."""
    if a == 0.0:
        return (-c / b,) if b else ()
    inside = b * b - 4.0 * a * c
    if inside < 0.0:
        return ()
    # The sum without cancellation first, the other root from the product of both.
    q = -0.5 * (b + math.copysign(math.sqrt(inside), b))
    return (q / a, c / q) if q else (0.0,)
