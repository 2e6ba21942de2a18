"""Read a road: its links, its reference line and all that lies along it."""

from itertools import pairwise

from mjdrive.town.opendrive.curves import curve_length
from mjdrive.town.opendrive.flattening import HeightGauge
from mjdrive.town.opendrive.lane_reader import read_lane_offsets, read_sections
from mjdrive.town.opendrive.object_reader import read_objects
from mjdrive.town.opendrive.road_map import Road, RoadLink
from mjdrive.town.opendrive.road_shapes import Arc, Line, ParamPoly3, Piece, Poly3, Shape, Spiral
from mjdrive.town.opendrive.signal_reader import read_references, read_signals
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

LONGEST_ROAD = 100_000.0
"""Longest road that is read [m]."""

SHORTEST_PIECE = 1e-6
"""Shortest road, lane section and piece of a reference line [m]."""

LARGEST_TURN = 1000.0
"""Largest angle that a piece of a reference line turns by [rad]."""

LARGEST_GAP = 0.01
"""Largest gap or overlap, in s, between pieces of a reference line [m]."""

_SHAPES = ("line", "arc", "spiral", "poly3", "paramPoly3")


def read_road(fields: XmlFields, element: Element, gauge: HeightGauge) -> Road:
    """Read a road.

    Args:
        fields: Takes values out of the document.
        element: The road.
        gauge: Measures its heights.

    Returns:
        The road.

    Raises:
        TownFormatError: If it is no road that can be driven in the plane.
    """
    length = fields.number(element, "length")
    if not SHORTEST_PIECE < length <= LONGEST_ROAD:
        fields.fail(
            element, f"has length='{length:g}'; expected more than 0 and at most {LONGEST_ROAD:g}."
        )
    gauge.measure(element, length)
    pieces = _read_pieces(fields, element, length)
    sections = read_sections(fields, element, length)
    drives_on_left = fields.choice(element, "rule", ("RHT", "LHT"), "RHT") == "LHT"
    junction = fields.optional(element, "junction", "-1")
    return Road(
        id=fields.text(element, "id"),
        name=fields.optional(element, "name"),
        length=length,
        junction=None if junction == "-1" else junction,
        pieces=pieces,
        lane_offsets=read_lane_offsets(fields, element),
        sections=sections,
        predecessor=_read_link(fields, fields.child(element, "link", "predecessor")),
        successor=_read_link(fields, fields.child(element, "link", "successor")),
        signals=read_signals(fields, element, length, sections, drives_on_left=drives_on_left),
        references=read_references(
            fields, element, length, sections, drives_on_left=drives_on_left
        ),
        objects=read_objects(fields, element, length, pieces),
        drives_on_left=drives_on_left,
    )


def _read_link(fields: XmlFields, element: Element | None) -> RoadLink | None:
    if element is None:
        return None
    kind = fields.choice(element, "elementType", ("road", "junction"))
    if "elementS" in element.attrib:
        # A road of a virtual junction leaves its main road in between; lanes of mjdrive meet at their ends.
        fields.asked[element.tag].update(("elementS", "elementDir", "elementId"))
        fields.note("road link that meets a road between its ends (elementS)")
        return None
    contact = fields.choice(element, "contactPoint", ("start", "end")) if kind == "road" else None
    return RoadLink(kind, fields.text(element, "elementId"), contact)


def _read_pieces(fields: XmlFields, road: Element, length: float) -> tuple[Piece, ...]:
    elements = fields.some(road, "planView", "geometry")
    pieces = [_read_piece(fields, element) for element in elements]
    end = 0.0
    for piece, element in zip(pieces, elements, strict=True):
        if abs(piece.s - end) > LARGEST_GAP:
            fields.fail(element, f"starts at s={piece.s:g}; expected {end:g}, without a gap.")
        end = piece.s + piece.length
    if any(later.s <= piece.s for piece, later in pairwise(pieces)):
        fields.fail(road, "has pieces of its reference line out of order; expected rising s.")
    if abs(end - length) > LARGEST_GAP:
        fields.fail(
            road, f"has length='{length:g}', but its geometry ends at {end:g}; expected the same."
        )
    return tuple(pieces)


def _read_piece(fields: XmlFields, element: Element) -> Piece:
    s, x, y, heading, length = (
        fields.number(element, name) for name in ("s", "x", "y", "hdg", "length")
    )
    if length <= SHORTEST_PIECE:
        fields.fail(element, f"has length='{length:g}'; expected more than {SHORTEST_PIECE:g}.")
    shapes = [child for child in element.iterchildren("*") if child.tag in _SHAPES]
    if len(shapes) != 1:
        found = ", ".join(f"<{child.tag}>" for child in element.iterchildren("*")) or "nothing"
        expected = ", ".join(f"<{tag}>" for tag in _SHAPES)
        fields.fail(element, f"holds {found}; expected one of {expected}.")
    fields.used.add(shapes[0])
    return Piece(s, x, y, heading, length, _read_shape(fields, shapes[0], length))


def _read_shape(fields: XmlFields, element: Element, length: float) -> Shape:
    shape: Shape
    match element.tag:
        case "line":
            return Line()
        case "arc":
            shape = Arc(fields.number(element, "curvature"))
            sharpest = abs(shape.curvature)
        case "spiral":
            shape = Spiral(fields.number(element, "curvStart"), fields.number(element, "curvEnd"))
            sharpest = max(abs(shape.start_curvature), abs(shape.end_curvature))
        case "poly3":
            a, b, c, d = (fields.number(element, name) for name in "abcd")
            return Poly3(a, b, c, d)
        case _:
            return _read_param_poly3(fields, element, length)
    if sharpest * length > LARGEST_TURN:
        fields.fail(
            element, f"turns by up to {sharpest * length:g} rad; expected at most {LARGEST_TURN:g}."
        )
    return shape


def _read_param_poly3(fields: XmlFields, element: Element, length: float) -> ParamPoly3:
    au, bu, cu, du = (fields.number(element, f"{name}U") for name in "abcd")
    av, bv, cv, dv = (fields.number(element, f"{name}V") for name in "abcd")
    # OpenDRIVE 1.4 made the range optional, 0 to 1 unless it says otherwise.
    span = fields.choice(element, "pRange", ("normalized", "arcLength"), "normalized")
    shape = ParamPoly3((au, bu, cu, du), (av, bv, cv, dv), span == "normalized")
    true_length = curve_length(shape, length)
    if true_length <= SHORTEST_PIECE:
        fields.fail(element, "has no length; expected a curve.")
    if abs(true_length - length) > 0.01 * length:
        fields.note("paramPoly3 whose length is over 1 % from that of its geometry")
    return shape
