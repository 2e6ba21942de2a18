"""Read what is painted along the edges of lanes."""

from mjdrive.town.opendrive.road_shapes import RoadMark
from mjdrive.town.opendrive.vocabulary import MARK_COLORS
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

SHORTEST_DASH = 0.1
"""Shortest dash of a road mark, with its gap [m]."""


def read_marks(fields: XmlFields, lane: Element) -> tuple[RoadMark, ...]:
    """Read the marks along the outer edge of a lane.

    Args:
        fields: Takes values out of the document.
        lane: The lane.

    Returns:
        The marks in order.

    Raises:
        TownFormatError: If they are out of order.
    """
    marks: list[RoadMark] = []
    for element in fields.each(lane, "roadMark"):
        mark = _read_mark(fields, element)
        if marks and mark.start < marks[-1].start:
            fields.fail(
                element, f"starts at {mark.start:g}, before the one above; expected rising sOffset."
            )
        marks.append(mark)
    return tuple(marks)


def _read_mark(fields: XmlFields, element: Element) -> RoadMark:
    width = fields.number(element, "width", 0.0)
    dash = gap = 0.0
    kind = fields.child(element, "type")
    if kind is not None:
        width = width or fields.number(kind, "width", 0.0)
        lines = [line for line in _read_lines(fields, kind) if not _is_dust(fields, line)]
        width = width or next((line[2] for line in lines), 0.0)
        dash, gap = next(((line[0], line[1]) for line in lines if line[1] > 0.0), (0.0, 0.0))
        if len({line[:2] for line in lines if line[1] > 0.0}) > 1:
            fields.note("road mark with lines of different dashes; the first is used")
    return RoadMark(
        type=fields.text(element, "type"),
        color=_read_color(fields, element),
        width=max(width, 0.0),
        start=fields.number(element, "sOffset"),
        dash=dash,
        gap=gap,
    )


def _is_dust(fields: XmlFields, line: tuple[float, float, float]) -> bool:
    """Tell whether the dashes of a line are too short to be painted; such a line counts as not given."""
    is_dust = line[1] > 0.0 and line[0] + line[1] < SHORTEST_DASH
    if is_dust:
        fields.note(f"road mark with dashes and gaps shorter than {SHORTEST_DASH:g} m")
    return is_dust


def _read_color(fields: XmlFields, mark: Element) -> str:
    color = fields.optional(mark, "color", "standard")
    if color.lower() in MARK_COLORS:
        return color.lower()
    fields.note(f"road mark color '{color[:40]}'")
    return "white"


def _read_lines(fields: XmlFields, kind: Element) -> list[tuple[float, float, float]]:
    """Length of a dash, gap and width of each line [m]; 0 where the map does not say."""
    # Where exactly the lines lie and dashes begin follows from the type of the mark.
    fields.asked["line"].update(("sOffset", "tOffset"))
    return [
        (
            max(fields.number(line, "length", 0.0), 0.0),
            max(fields.number(line, "space", 0.0), 0.0),
            max(fields.number(line, "width", 0.0), 0.0),
        )
        for line in fields.each(kind, "line")
    ]
