"""Read an ASAM OpenDRIVE map (.xodr) into a `RoadMap`."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lxml import etree

from mjdrive.errors import TownFormatError
from mjdrive.town.road_map import (
    Connection,
    Junction,
    LaneRecord,
    LaneSection,
    Road,
    RoadLink,
    RoadMap,
    SignalRecord,
    SignalReference,
)
from mjdrive.town.road_shapes import Arc, Cubic, Line, Piece, RoadMark
from mjdrive.town.xml_fields import Element, XmlFields

_FLAT = 1e-6
"""Largest elevation, slope and superelevation that still count as flat [m, -, rad]."""


def read(path: Path) -> RoadMap:
    """Read a map from a file.

    Args:
        path: OpenDRIVE file.

    Returns:
        The road network that it describes.

    Raises:
        TownFormatError: If the file is missing, is no OpenDRIVE, or uses what mjdrive cannot drive on.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise TownFormatError(
            f"Cannot read the map '{path}': {error.strerror}. Expected an OpenDRIVE file (.xodr)."
        ) from error
    return parse(data, source=str(path))


def parse(data: bytes, *, source: str) -> RoadMap:
    """Read a map from the bytes of an OpenDRIVE file.

    Args:
        data: The XML document.
        source: How errors call it.

    Returns:
        The road network that it describes.

    Raises:
        TownFormatError: If it is no OpenDRIVE, or uses what mjdrive cannot drive on.
    """
    # A map comes from anywhere: entities are left alone and nothing is fetched.
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise TownFormatError(
            f"'{source}' is no XML: {error}. Expected an OpenDRIVE map."
        ) from error
    if root.tag != "OpenDRIVE":
        raise TownFormatError(f"'{source}' starts with <{root.tag}>; expected <OpenDRIVE>.")
    return _Reader(source).road_map(root)


class _Reader(XmlFields):
    """Walks one map."""

    def road_map(self, root: Element) -> RoadMap:
        header = root.find("header")
        roads = [self.road(element) for element in root.iterfind("road")]
        if not roads:
            self.fail(root, "has no <road>.")
        return RoadMap(
            name="" if header is None else header.get("name", ""),
            roads=self.unique(root, "road", [(road.id, road) for road in roads]),
            junctions=self.unique(
                root,
                "junction",
                [(e.get("id"), self.junction(e)) for e in root.iterfind("junction")],
            ),
            controllers={
                self.text(e, "id"): tuple(
                    # RoadRunner lists a signal twice where two of its lanes turn.
                    dict.fromkeys(
                        self.text(control, "signalId") for control in e.iterfind("control")
                    )
                )
                for e in root.iterfind("controller")
            },
        )

    def unique(self, root: Element, kind: str, items: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(items)
        if len(found) < len(items):
            self.fail(root, f"has two elements <{kind}> with the same id.")
        return found

    def road(self, element: Element) -> Road:
        self.refuse_slopes(element)
        junction = self.text(element, "junction")
        return Road(
            id=self.text(element, "id"),
            name=element.get("name", ""),
            length=self.number(element, "length"),
            junction=None if junction == "-1" else junction,
            pieces=tuple(self.piece(e) for e in self.some(element, "planView/geometry")),
            lane_offsets=tuple(self.cubic(e, "s") for e in element.iterfind("lanes/laneOffset")),
            sections=tuple(self.section(e) for e in self.some(element, "lanes/laneSection")),
            predecessor=self.link(element.find("link/predecessor")),
            successor=self.link(element.find("link/successor")),
            signals=tuple(self.signal(e) for e in element.iterfind("signals/signal")),
            references=tuple(
                SignalReference(self.text(e, "id"), *self.validity(e))
                for e in element.iterfind("signals/signalReference")
            ),
        )

    def refuse_slopes(self, road: Element) -> None:
        for path in ("elevationProfile/elevation", "lateralProfile/superelevation"):
            for element in road.iterfind(path):
                if any(abs(self.number(element, name)) > _FLAT for name in "abcd"):
                    self.fail(element, "is not 0; mjdrive towns are flat.")

    def piece(self, element: Element) -> Piece:
        shapes = [
            child for child in element if isinstance(child.tag, str) and child.tag != "userData"
        ]
        if len(shapes) != 1 or shapes[0].tag not in ("line", "arc"):
            found = ", ".join(f"<{shape.tag}>" for shape in shapes) or "nothing"
            self.fail(element, f"holds {found}; mjdrive drives on <line> and <arc>.")
        shape = Arc(self.number(shapes[0], "curvature")) if shapes[0].tag == "arc" else Line()
        s, x, y, heading, length = (
            self.number(element, name) for name in ("s", "x", "y", "hdg", "length")
        )
        return Piece(s, x, y, heading, length, shape)

    def cubic(self, element: Element, start: str) -> Cubic:
        return Cubic(*(self.number(element, name) for name in (start, "a", "b", "c", "d")))

    def section(self, element: Element) -> LaneSection:
        lanes = [
            self.lane(e)
            for side in ("left", "center", "right")
            for e in element.iterfind(f"{side}/lane")
        ]
        lanes.sort(key=lambda lane: -lane.id)
        ids = [lane.id for lane in lanes]
        if 0 not in ids or ids != list(range(ids[0], ids[-1] - 1, -1)):
            self.fail(
                element, f"has lanes {ids}; expected whole numbers without a gap that include 0."
            )
        return LaneSection(self.number(element, "s"), tuple(lanes))

    def lane(self, element: Element) -> LaneRecord:
        ends = {
            e.tag: self.integer(e, "id")
            for e in element.iterfind("link/*")
            if isinstance(e.tag, str)
        }
        if (border := element.find("border")) is not None:
            self.fail(border, "is not read; give lanes a <width>.")
        lane = LaneRecord(
            id=self.integer(element, "id"),
            type=self.text(element, "type"),
            widths=tuple(self.cubic(e, "sOffset") for e in element.iterfind("width")),
            predecessor=ends.get("predecessor"),
            successor=ends.get("successor"),
            marks=tuple(self.mark(e) for e in element.iterfind("roadMark")),
        )
        if lane.id and not lane.widths:
            self.fail(element, "has no <width>.")
        return lane

    def mark(self, element: Element) -> RoadMark:
        width = self.number(element, "width") if "width" in element.attrib else 0.0
        start = self.number(element, "sOffset")
        return RoadMark(self.text(element, "type"), element.get("color", "standard"), width, start)

    def link(self, element: Element | None) -> RoadLink | None:
        if element is None:
            return None
        kind = self.text(element, "elementType")
        contact = self.text(element, "contactPoint") if kind == "road" else None
        return RoadLink(kind, self.text(element, "elementId"), contact)

    def signal(self, element: Element) -> SignalRecord:
        from_lane, to_lane = self.validity(element)
        return SignalRecord(
            id=self.text(element, "id"),
            name=element.get("name", ""),
            type=self.text(element, "type"),
            s=self.number(element, "s"),
            t=self.number(element, "t"),
            orientation=self.text(element, "orientation"),
            from_lane=from_lane,
            to_lane=to_lane,
            dynamic=element.get("dynamic") == "yes",
            value=self.number(element, "value") if "value" in element.attrib else -1.0,
            unit=element.get("unit", ""),
        )

    def validity(self, element: Element) -> tuple[int, int]:
        spans: Iterator[tuple[int, int]] = (
            (self.integer(e, "fromLane"), self.integer(e, "toLane"))
            for e in element.iterfind("validity")
        )
        lanes = [lane for span in spans for lane in span]
        return (min(lanes), max(lanes)) if lanes else (0, 0)

    def junction(self, element: Element) -> Junction:
        controllers = sorted(
            element.iterfind("controller"), key=lambda e: int(e.get("sequence", "0"))
        )
        return Junction(
            id=self.text(element, "id"),
            name=element.get("name", ""),
            connections=tuple(self.connection(e) for e in element.iterfind("connection")),
            controllers=tuple(self.text(e, "id") for e in controllers),
        )

    def connection(self, element: Element) -> Connection:
        return Connection(
            id=self.text(element, "id"),
            incoming=self.text(element, "incomingRoad"),
            connecting=self.text(element, "connectingRoad"),
            contact=self.text(element, "contactPoint"),
            lane_links=tuple(
                (self.integer(e, "from"), self.integer(e, "to"))
                for e in element.iterfind("laneLink")
            ),
        )
