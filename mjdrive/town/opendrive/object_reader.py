"""Read what stands beside a road or lies on it."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mjdrive.geometry import world_from_vehicle
from mjdrive.town.opendrive.object_outlines import (
    Size,
    counter_clockwise,
    local_corners,
    outline_height,
    place,
    road_corners,
)
from mjdrive.town.opendrive.object_repeats import read_repeats
from mjdrive.town.opendrive.road_map import ObjectRecord
from mjdrive.town.opendrive.road_shapes import Piece
from mjdrive.town.opendrive.signal_reader import read_station
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

LARGEST_OBJECT = 1000.0
"""Largest height of an object, and its largest extent in x and y; one along a road is that much longer than it [m]."""


def read_objects(
    fields: XmlFields, road: Element, length: float, pieces: Sequence[Piece]
) -> tuple[ObjectRecord, ...]:
    """Read the objects of a road; one that repeats is as many objects.

    Args:
        fields: Takes values out of the document.
        road: The road.
        length: Its length [m].
        pieces: Its reference line.

    Returns:
        The objects; those without extent have an empty outline.

    Raises:
        TownFormatError: If a value is missing or is no number, or if an object is larger than `LARGEST_OBJECT`.
    """
    found: list[ObjectRecord] = []
    for element in fields.each(road, "objects", "object"):
        for thing in _read_object(fields, element, length, pieces):
            _require_bounded(fields, element, thing, length)
            found.append(thing)
    for thing in found:
        if not thing.outline:
            fields.note(f"object of type '{thing.type}' without extent")
    return tuple(found)


def _read_object(
    fields: XmlFields, element: Element, length: float, pieces: Sequence[Piece]
) -> Iterator[ObjectRecord]:
    size = Size(*(fields.number(element, name, 0.0) for name in ("length", "width", "radius")))
    thing = ObjectRecord(
        id=fields.text(element, "id"),
        name=fields.optional(element, "name"),
        type=fields.optional(element, "type", "none"),
        s=read_station(fields, element, length),
        t=fields.number(element, "t"),
        heading=fields.number(element, "hdg", 0.0),
        outline=(),
        height=outline_height(fields, element),
    )
    corners = road_corners(fields, element, length, pieces)
    if corners is not None:
        # Corners along the road say where the object is: they cannot repeat.
        yield replace(thing, outline=counter_clockwise(corners))
        return
    repeats = list(read_repeats(fields, element, thing, size, length=length, pieces=pieces))
    if repeats:
        yield from repeats
        return
    (x, y), yaw = place(pieces, thing.s, thing.t)
    local = local_corners(fields, element, size)
    corners = world_from_vehicle(local, x=x, y=y, yaw=yaw + thing.heading)
    yield replace(thing, outline=counter_clockwise(corners))


def _require_bounded(
    fields: XmlFields, element: Element, thing: ObjectRecord, length: float
) -> None:
    along = next(element.iter("cornerRoad", "repeat"), None) is not None
    largest = LARGEST_OBJECT + (length if along else 0.0)
    extent = float(np.ptp(np.array(thing.outline), axis=0).max()) if thing.outline else 0.0
    if extent > largest:
        fields.fail(element, f"covers {extent:g} m of ground; expected at most {largest:g} m.")
    if thing.height > LARGEST_OBJECT:
        fields.fail(element, f"is {thing.height:g} m high; expected at most {LARGEST_OBJECT:g} m.")
