"""Read the junctions of a map."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from mjdrive.town.opendrive.road_map import Connection, Junction, Road
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

_CONTACTS = ("start", "end")


def read_junction(fields: XmlFields, element: Element) -> Junction:
    """Read a junction.

    Args:
        fields: Takes values out of the document.
        element: The junction.

    Returns:
        The junction; a virtual one, which roads cross between their ends, has no connections.

    Raises:
        TownFormatError: If a value is missing or has no meaning.
    """
    kind = fields.optional(element, "type", "default")
    connections: tuple[Connection, ...] = ()
    if kind in ("default", "direct"):
        road = "connectingRoad" if kind == "default" else "linkedRoad"
        connections = tuple(
            _read_connection(fields, e, road)
            for e in fields.each(element, "connection")
            if not _is_virtual(fields, e)
        )
    else:
        fields.note(f"junction type '{kind}'")
    controllers = [
        (_read_sequence(fields, e), fields.text(e, "id"))
        for e in fields.each(element, "controller")
    ]
    return Junction(
        id=fields.text(element, "id"),
        name=fields.optional(element, "name"),
        connections=connections,
        controllers=tuple(
            name for _, name in sorted(controllers, key=lambda controller: controller[0])
        ),
    )


def with_ways_back(
    root: Element, roads: Mapping[str, Road], junctions: Mapping[str, Junction]
) -> dict[str, Junction]:
    """Add the ways back to direct junctions, whose connections name two roads that meet and hold both ways.

    Args:
        root: The document.
        roads: Every road by id.
        junctions: Every junction by id.

    Returns:
        The junctions.
    """
    direct = {
        element.get("id")
        for element in root.iterchildren("junction")
        if element.get("type") == "direct"
    }
    return {
        id: replace(junction, connections=_both_ways(junction, roads)) if id in direct else junction
        for id, junction in junctions.items()
    }


def _both_ways(junction: Junction, roads: Mapping[str, Road]) -> tuple[Connection, ...]:
    known = {(c.incoming, c.connecting) for c in junction.connections}
    back = [
        Connection(
            id=f"{c.id}_back",
            incoming=c.connecting,
            connecting=c.incoming,
            contact=contact,
            lane_links=tuple((there, here) for here, there in c.lane_links),
        )
        for c in junction.connections
        if (c.connecting, c.incoming) not in known
        for contact in _contacts(roads[c.incoming], junction.id)
    ]
    return (*junction.connections, *back)


def _contacts(road: Road, junction: str) -> Iterator[str]:
    """The ends at which a road meets a junction."""
    for contact, link in zip(_CONTACTS, (road.predecessor, road.successor), strict=True):
        if link is not None and link.kind == "junction" and link.id == junction:
            yield contact


def _is_virtual(fields: XmlFields, connection: Element) -> bool:
    if fields.optional(connection, "type", "default") == "virtual":
        fields.note("junction connection type 'virtual'")
        return True
    return False


def _read_connection(fields: XmlFields, element: Element, road: str) -> Connection:
    return Connection(
        id=fields.text(element, "id"),
        incoming=fields.text(element, "incomingRoad"),
        connecting=fields.text(element, road),
        contact=fields.choice(element, "contactPoint", _CONTACTS),
        lane_links=tuple(
            (fields.integer(e, "from"), fields.integer(e, "to"))
            for e in fields.each(element, "laneLink")
        ),
    )


def _read_sequence(fields: XmlFields, controller: Element) -> int:
    return fields.integer(controller, "sequence") if "sequence" in controller.attrib else 0
