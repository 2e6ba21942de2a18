"""Check that the parts of a map refer to parts that it has."""

from collections.abc import Iterable, Iterator, Mapping

from mjdrive.town.opendrive.road_map import Junction, Road, RoadLink
from mjdrive.town.opendrive.xml_fields import Element, XmlFields


def unique_by_id(fields: XmlFields, elements: Iterable[Element]) -> Iterator[tuple[str, Element]]:
    """Go through elements of which no two may have the same id.

    Args:
        fields: Takes values out of the document.
        elements: Elements with an attribute "id".

    Yields:
        The id and the element.

    Raises:
        TownFormatError: If an id is there twice.
    """
    lines: dict[str, int] = {}
    for element in elements:
        name = fields.text(element, "id")
        if name in lines:
            fields.fail(
                element,
                f"has id='{name}', as the one in line {lines[name]}; expected different ids.",
            )
        lines[name] = element.sourceline
        yield name, element


def require_whole(
    fields: XmlFields,
    root: Element,
    roads: Mapping[str, Road],
    junctions: Mapping[str, Junction],
) -> None:
    """Check that links, junctions and connections lead to what the map has, and that no signal is there twice.

    Args:
        fields: Takes values out of the document.
        root: The document.
        roads: Every road by id.
        junctions: Every junction by id.

    Raises:
        TownFormatError: If something is missing.
    """
    for element in root.iterchildren("road"):
        road = roads[element.get("id")]
        if road.junction is not None and road.junction not in junctions:
            fields.fail(
                element, f"crosses junction '{road.junction}', which the map does not have."
            )
        for tag, link in (("predecessor", road.predecessor), ("successor", road.successor)):
            if link is not None and not _leads_somewhere(link, roads, junctions):
                fields.fail(
                    element.find(f"link/{tag}"),
                    f"leads to {link.kind} '{link.id}', which the map does not have.",
                )
    for element in root.iterchildren("junction"):
        for connection in element.iterchildren("connection"):
            for name in ("incomingRoad", "connectingRoad", "linkedRoad"):
                road_id = connection.get(name)
                if connection in fields.used and road_id is not None and road_id not in roads:
                    fields.fail(connection, f"has {name}='{road_id}', which is no road of the map.")
    _require_different_signals(fields, root)


def _leads_somewhere(
    link: RoadLink, roads: Mapping[str, Road], junctions: Mapping[str, Junction]
) -> bool:
    return link.id in (roads if link.kind == "road" else junctions)


def _require_different_signals(fields: XmlFields, root: Element) -> None:
    signals = list(root.iterfind("road/signals/signal"))
    known = {name for name, _ in unique_by_id(fields, signals)}
    for reference in root.iterfind("road/signals/signalReference"):
        if reference.get("id") not in known:
            fields.note("signalReference to a signal that the map does not have")
