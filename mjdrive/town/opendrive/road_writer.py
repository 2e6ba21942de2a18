"""Write a `Road` as an OpenDRIVE element."""

import numpy as np
from lxml import etree

from mjdrive.geometry import vehicle_from_world
from mjdrive.town.opendrive.reference_line import reference_line
from mjdrive.town.opendrive.road_map import (
    LaneRecord,
    ObjectRecord,
    Road,
    RoadLink,
    SignalRecord,
    SignalReference,
)
from mjdrive.town.opendrive.road_shapes import (
    Arc,
    Cubic,
    Line,
    ParamPoly3,
    Piece,
    Poly3,
    RoadMark,
    Spiral,
)
from mjdrive.town.opendrive.xml_fields import Element

_SIDES = (("left", 1), ("center", 0), ("right", -1))


def add(parent: Element, tag: str, **attributes: str | int | float) -> Element:
    """Add a child to an element; numbers are written with all their digits."""
    texts = {
        name: value if isinstance(value, str) else repr(value) for name, value in attributes.items()
    }
    return etree.SubElement(parent, tag, texts)


def add_road(root: Element, road: Road) -> None:
    """Add a road to a document.

    Args:
        root: The root of the document.
        road: The road.
    """
    element = add(
        root,
        "road",
        name=road.name,
        length=road.length,
        id=road.id,
        junction=road.junction or "-1",
        rule="LHT" if road.drives_on_left else "RHT",
    )
    link = add(element, "link")
    _add_link(link, "predecessor", road.predecessor)
    _add_link(link, "successor", road.successor)
    add(element, "type", s=0.0, type="town")
    plan = add(element, "planView")
    for piece in road.pieces:
        _add_piece(plan, piece)
    _add_lanes(add(element, "lanes"), road)
    if road.objects:
        objects = add(element, "objects")
        for thing in road.objects:
            _add_object(objects, road, thing)
    if road.signals or road.references:
        signals = add(element, "signals")
        for signal in road.signals:
            _add_signal(signals, signal)
        for reference in road.references:
            _add_reference(signals, reference)


def _add_link(parent: Element, tag: str, link: RoadLink | None) -> None:
    if link is not None:
        contact = {} if link.contact is None else {"contactPoint": link.contact}
        add(parent, tag, elementType=link.kind, elementId=link.id, **contact)


def _add_piece(plan: Element, piece: Piece) -> None:
    place = {"s": piece.s, "x": piece.x, "y": piece.y, "hdg": piece.heading}
    geometry = add(plan, "geometry", **place, length=piece.length)
    match piece.shape:
        case Line():
            add(geometry, "line")
        case Arc(curvature):
            add(geometry, "arc", curvature=curvature)
        case Spiral(start, end):
            add(geometry, "spiral", curvStart=start, curvEnd=end)
        case Poly3(a, b, c, d):
            add(geometry, "poly3", a=a, b=b, c=c, d=d)
        case ParamPoly3(u, v, is_normalized):
            names = [name + axis for axis in "UV" for name in "abcd"]
            span = "normalized" if is_normalized else "arcLength"
            add(geometry, "paramPoly3", **dict(zip(names, u + v, strict=True)), pRange=span)


def _add_lanes(parent: Element, road: Road) -> None:
    for offset in road.lane_offsets:
        _add_cubic(parent, "laneOffset", "s", offset)
    for section in road.sections:
        element = add(parent, "laneSection", s=section.s)
        for side, sign in _SIDES:
            lanes = [lane for lane in section.lanes if np.sign(lane.id) == sign]
            if lanes:
                holder = add(element, side)
                for lane in lanes:
                    _add_lane(holder, lane)


def _add_lane(parent: Element, lane: LaneRecord) -> None:
    direction = {} if lane.direction == "standard" else {"direction": lane.direction}
    element = add(parent, "lane", id=lane.id, type=lane.type, level="false", **direction)
    if lane.predecessor is not None or lane.successor is not None:
        link = add(element, "link")
        for tag, number in (("predecessor", lane.predecessor), ("successor", lane.successor)):
            if number is not None:
                add(link, tag, id=number)
    for width in lane.widths:
        _add_cubic(element, "width", "sOffset", width)
    for border in lane.borders:
        _add_cubic(element, "border", "sOffset", border)
    for mark in lane.marks:
        _add_mark(element, mark)


def _add_cubic(parent: Element, tag: str, start: str, cubic: Cubic) -> None:
    add(parent, tag, **{start: cubic.start}, a=cubic.a, b=cubic.b, c=cubic.c, d=cubic.d)


def _add_mark(lane: Element, mark: RoadMark) -> None:
    element = add(
        lane,
        "roadMark",
        sOffset=mark.start,
        type=mark.type,
        weight="standard",
        color=mark.color,
        width=mark.width,
        laneChange="none",
    )
    if mark.dash > 0.0:
        kind = add(element, "type", name=mark.type, width=mark.width)
        add(kind, "line", length=mark.dash, space=mark.gap, tOffset=0.0, sOffset=0.0)


def _add_object(parent: Element, road: Road, thing: ObjectRecord) -> None:
    element = add(
        parent,
        "object",
        id=thing.id,
        name=thing.name,
        type=thing.type,
        s=thing.s,
        t=thing.t,
        zOffset=0.0,
        hdg=thing.heading,
        orientation="none",
        height=thing.height,
    )
    if not thing.outline:
        return
    (point,), (heading,) = reference_line(road.pieces, np.array([thing.s]))
    x, y = point + thing.t * np.array([-np.sin(heading), np.cos(heading)])
    yaw = float(heading) + thing.heading
    corners = vehicle_from_world(np.array(thing.outline), x=float(x), y=float(y), yaw=yaw)
    outline = add(add(element, "outlines"), "outline", id=0, outer="true", closed="true")
    for index, (u, v) in enumerate(corners.tolist()):
        # Rounded to a nanometre: a map file that people can read.
        place = {"u": round(u, 9), "v": round(v, 9), "z": 0.0}
        add(outline, "cornerLocal", id=index, **place, height=thing.height)


def _add_signal(parent: Element, signal: SignalRecord) -> None:
    unit = {"unit": signal.unit} if signal.unit else {}
    element = add(
        parent,
        "signal",
        s=signal.s,
        t=signal.t,
        id=signal.id,
        name=signal.name,
        dynamic="yes" if signal.dynamic else "no",
        orientation=signal.orientation,
        zOffset=0.0,
        country="OpenDRIVE",
        type=signal.type,
        subtype="-1",
        value=signal.value,
        **unit,
    )
    add(element, "validity", fromLane=signal.from_lane, toLane=signal.to_lane)


def _add_reference(parent: Element, reference: SignalReference) -> None:
    element = add(
        parent,
        "signalReference",
        s=reference.s,
        t=0.0,
        id=reference.id,
        orientation=reference.orientation,
    )
    add(element, "validity", fromLane=reference.from_lane, toLane=reference.to_lane)
