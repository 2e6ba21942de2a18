"""Write a `RoadMap` as ASAM OpenDRIVE 1.4; `opendrive.parse` reads it back unchanged."""

from lxml import etree

from mjdrive.town.lane_geometry import lane_centre
from mjdrive.town.road_map import Junction, LaneRecord, Road, RoadLink, RoadMap, SignalRecord
from mjdrive.town.road_shapes import Arc, Cubic, Line, ParamPoly3, Poly3, Spiral
from mjdrive.town.xml_fields import Element

_SIDES = ("left", "center", "right")


def write(road_map: RoadMap) -> bytes:
    """Write a map; the same map gives the same bytes.

    Args:
        road_map: The road network.

    Returns:
        The XML document.
    """
    root = etree.Element("OpenDRIVE")
    _header(root, road_map)
    for road in road_map.roads.values():
        _road(root, road)
    for order, (controller, signals) in enumerate(road_map.controllers.items()):
        element = _add(
            root, "controller", id=controller, name=f"Controller {controller}", sequence=order
        )
        for signal in signals:
            _add(element, "control", signalId=signal, type="")
    for junction in road_map.junctions.values():
        _junction(root, junction)
    etree.indent(root, space=" ")
    document: bytes = etree.tostring(root, xml_declaration=True, encoding="UTF-8")
    return document + b"\n"


def _add(parent: Element, tag: str, **attributes: str | int | float) -> Element:
    texts = {
        name: value if isinstance(value, str) else repr(value) for name, value in attributes.items()
    }
    return etree.SubElement(parent, tag, texts)


def _header(root: Element, road_map: RoadMap) -> None:
    edges = [
        lane_centre(road, index, lane.id)[0]
        for road in road_map.roads.values()
        for index, section in enumerate(road.sections)
        for lane in section.lanes
        if lane.id
    ]
    x, y = (
        sorted(float(value) for points in edges for value in points[:, axis]) for axis in (0, 1)
    )
    _add(
        root,
        "header",
        revMajor="1",
        revMinor="4",
        name=road_map.name,
        version="1.00",
        north=round(y[-1], 3),
        south=round(y[0], 3),
        east=round(x[-1], 3),
        west=round(x[0], 3),
        vendor="mjdrive",
    )


def _road(root: Element, road: Road) -> None:
    element = _add(
        root, "road", name=road.name, length=road.length, id=road.id, junction=road.junction or "-1"
    )
    link = _add(element, "link")
    _link(link, "predecessor", road.predecessor)
    _link(link, "successor", road.successor)
    _add(element, "type", s=0.0, type="town")
    plan = _add(element, "planView")
    for piece in road.pieces:
        geometry = _add(
            plan,
            "geometry",
            s=piece.s,
            x=piece.x,
            y=piece.y,
            hdg=piece.heading,
            length=piece.length,
        )
        match piece.shape:
            case Line():
                _add(geometry, "line")
            case Arc(curvature):
                _add(geometry, "arc", curvature=curvature)
            case Spiral(start, end):
                _add(geometry, "spiral", curvStart=start, curvEnd=end)
            case Poly3(a, b, c, d):
                _add(geometry, "poly3", a=a, b=b, c=c, d=d)
            case ParamPoly3(u, v, is_normalized):
                names = [name + axis for axis in "UV" for name in "abcd"]
                span = "normalized" if is_normalized else "arcLength"
                _add(geometry, "paramPoly3", **dict(zip(names, u + v, strict=True)), pRange=span)
    _lanes(_add(element, "lanes"), road)
    if road.signals or road.references:
        signals = _add(element, "signals")
        for signal in road.signals:
            _signal(signals, signal)
        for reference in road.references:
            mention = _add(
                signals, "signalReference", s=0.0, t=0.0, id=reference.id, orientation="none"
            )
            _add(mention, "validity", fromLane=reference.from_lane, toLane=reference.to_lane)


def _link(parent: Element, tag: str, link: RoadLink | None) -> None:
    if link is not None:
        contact = {} if link.contact is None else {"contactPoint": link.contact}
        _add(parent, tag, elementType=link.kind, elementId=link.id, **contact)


def _lanes(parent: Element, road: Road) -> None:
    for offset in road.lane_offsets:
        _cubic(parent, "laneOffset", "s", offset)
    for section in road.sections:
        element = _add(parent, "laneSection", s=section.s)
        for side, sign in zip(_SIDES, (1, 0, -1), strict=True):
            lanes = [lane for lane in section.lanes if (lane.id > 0) - (lane.id < 0) == sign]
            if lanes:
                holder = _add(element, side)
                for lane in lanes:
                    _lane(holder, lane)


def _lane(parent: Element, lane: LaneRecord) -> None:
    element = _add(parent, "lane", id=lane.id, type=lane.type, level="false")
    if lane.predecessor is not None or lane.successor is not None:
        link = _add(element, "link")
        for tag, number in (("predecessor", lane.predecessor), ("successor", lane.successor)):
            if number is not None:
                _add(link, tag, id=number)
    for width in lane.widths:
        _cubic(element, "width", "sOffset", width)
    for mark in lane.marks:
        kind = {"type": mark.type, "weight": "standard", "color": mark.color}
        _add(element, "roadMark", sOffset=mark.start, **kind, width=mark.width, laneChange="none")


def _cubic(parent: Element, tag: str, start: str, cubic: Cubic) -> None:
    _add(parent, tag, **{start: cubic.start}, a=cubic.a, b=cubic.b, c=cubic.c, d=cubic.d)


def _signal(parent: Element, signal: SignalRecord) -> None:
    unit = {"unit": signal.unit} if signal.unit else {}
    element = _add(
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
    _add(element, "validity", fromLane=signal.from_lane, toLane=signal.to_lane)


def _junction(root: Element, junction: Junction) -> None:
    element = _add(root, "junction", id=junction.id, name=junction.name)
    for connection in junction.connections:
        child = _add(
            element,
            "connection",
            id=connection.id,
            incomingRoad=connection.incoming,
            connectingRoad=connection.connecting,
            contactPoint=connection.contact,
        )
        for here, there in connection.lane_links:
            _add(child, "laneLink", **{"from": here, "to": there})
    for order, controller in enumerate(junction.controllers):
        _add(element, "controller", id=controller, type="0", sequence=order)
