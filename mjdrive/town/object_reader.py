"""Read what stands beside a road or lies on it."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mjdrive.geometry import world_from_vehicle
from mjdrive.town.reference_line import reference_line
from mjdrive.town.road_map import ObjectRecord
from mjdrive.town.road_shapes import Piece
from mjdrive.town.signal_reader import read_station
from mjdrive.town.xml_fields import Element, XmlFields

_ROUND = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
"""Directions of the corners of a round object [rad]."""

_SMALLEST_AREA = 1e-6
"""Area below which an outline counts as none [m^2]."""

Corners = Float[np.ndarray, "N 2"]


def read_objects(
    fields: XmlFields, road: Element, length: float, pieces: Sequence[Piece]
) -> tuple[ObjectRecord, ...]:
    """Read the objects of a road; `<repeat>` is not followed, but reported.

    Args:
        fields: Takes values out of the document.
        road: The road.
        length: Its length [m].
        pieces: Its reference line.

    Returns:
        The objects; those without extent have an empty outline.

    Raises:
        TownFormatError: If a value is missing or is no number.
    """
    return tuple(
        _read_object(fields, element, length, pieces)
        for element in fields.each(road, "objects", "object")
    )


def _read_object(
    fields: XmlFields, element: Element, length: float, pieces: Sequence[Piece]
) -> ObjectRecord:
    kind = fields.optional(element, "type", "none")
    s, t = read_station(fields, element, length), fields.number(element, "t")
    heading = fields.number(element, "hdg", 0.0)
    origin, yaw = _place(pieces, s, t)
    corners, height = _read_corners(fields, element, length, pieces)
    if corners is None:
        local = _read_local_corners(fields, element)
        corners = world_from_vehicle(local, x=origin[0], y=origin[1], yaw=yaw + heading)
    outline = _counter_clockwise(corners)
    if not outline:
        fields.note(f"object of type '{kind}' without extent")
    return ObjectRecord(
        id=fields.text(element, "id"),
        name=fields.optional(element, "name"),
        type=kind,
        s=s,
        t=t,
        heading=heading,
        outline=outline,
        height=max(height, fields.number(element, "height", 0.0)),
    )


def _place(pieces: Sequence[Piece], s: float, t: float) -> tuple[tuple[float, float], float]:
    """Where a place beside a road is in the world [m], and the heading of the road there [rad]."""
    point, heading = reference_line(pieces, np.array([s]))
    yaw = float(heading[0])
    return (float(point[0, 0] - t * np.sin(yaw)), float(point[0, 1] + t * np.cos(yaw))), yaw


def _outline_of(fields: XmlFields, element: Element) -> Element | None:
    """The outer outline; any others of the object are reported as not used."""
    holder = fields.child(element, "outlines")
    outlines = (element if holder is None else holder).iterchildren("outline")
    outline = next((o for o in outlines if fields.optional(o, "outer", "true") != "false"), None)
    if outline is not None:
        fields.used.add(outline)
    return outline


def _read_corners(
    fields: XmlFields, element: Element, length: float, pieces: Sequence[Piece]
) -> tuple[Corners | None, float]:
    """Corners along the road in the world frame, None if the object has none [m]; and the largest height [m]."""
    outline = _outline_of(fields, element)
    corners = list(fields.each(outline, "cornerRoad"))
    if not corners:
        return None, 0.0
    points = [
        _place(pieces, read_station(fields, corner, length), fields.number(corner, "t"))[0]
        for corner in corners
    ]
    height = max(fields.number(corner, "height", 0.0) for corner in corners)
    return np.array(points), max(height, 0.0)


def _read_local_corners(fields: XmlFields, element: Element) -> Corners:
    """Corners in the frame of the object [m]: of its outline, else of its box or circle."""
    corners = list(fields.each(_outline_of(fields, element), "cornerLocal"))
    radius = fields.number(element, "radius", 0.0)
    half_length = 0.5 * fields.number(element, "length", 0.0)
    half_width = 0.5 * fields.number(element, "width", 0.0)
    if corners:
        return np.array([[fields.number(c, "u"), fields.number(c, "v")] for c in corners])
    if radius > 0.0:
        return radius * np.stack([np.cos(_ROUND), np.sin(_ROUND)], axis=1)
    box = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    return box * np.array([half_length, half_width])


def _counter_clockwise(corners: Corners) -> tuple[tuple[float, float], ...]:
    """Corners in order; none if they enclose nothing."""
    centred = corners - corners.mean(axis=0)
    following = np.roll(centred, -1, axis=0)
    area = 0.5 * float(np.sum(centred[:, 0] * following[:, 1] - centred[:, 1] * following[:, 0]))
    if abs(area) < _SMALLEST_AREA:
        return ()
    return tuple((float(x), float(y)) for x, y in (corners if area > 0.0 else corners[::-1]))
