"""Read the ground that objects cover."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.town.opendrive.reference_line import reference_line
from mjdrive.town.opendrive.road_shapes import Piece
from mjdrive.town.opendrive.signal_reader import read_station
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

_ROUND = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
"""Directions of the corners of a round object [rad]."""

_SMALLEST_AREA = 1e-6
"""Area below which an outline counts as none [m^2]."""

Corners = Float[np.ndarray, "N 2"]


class Size(NamedTuple):
    """Size of an object.

    Attributes:
        length: Along its heading [m].
        width: Across its heading [m].
        radius: Of a round object, else 0 [m].
    """

    length: float
    width: float
    radius: float


def place(pieces: Sequence[Piece], s: float, t: float) -> tuple[tuple[float, float], float]:
    """Find a place beside a road.

    Args:
        pieces: Reference line of the road.
        s: Where along the road [m].
        t: Where across it, positive to the left [m].

    Returns:
        The place in the world frame [m] and the heading of the road there [rad].
    """
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


def road_corners(
    fields: XmlFields, element: Element, length: float, pieces: Sequence[Piece]
) -> Corners | None:
    """Read corners that are given along the road.

    Args:
        fields: Takes values out of the document.
        element: The object.
        length: Length of the road [m].
        pieces: Its reference line.

    Returns:
        Corners in the world frame, shape (N, 2) [m], or None if the object has none of this kind.

    Raises:
        TownFormatError: If a value is missing or is no number.
    """
    points = [
        place(pieces, read_station(fields, corner, length), fields.number(corner, "t"))[0]
        for corner in fields.each(_outline_of(fields, element), "cornerRoad")
    ]
    return np.array(points) if points else None


def local_corners(fields: XmlFields, element: Element, size: Size) -> Corners:
    """Read corners in the frame of the object: of its outline, else of its circle or box.

    Args:
        fields: Takes values out of the document.
        element: The object.
        size: Its length, width and radius, for an object without outline.

    Returns:
        Corners, x forward and y left, shape (N, 2) [m].

    Raises:
        TownFormatError: If a value is missing or is no number.
    """
    corners = list(fields.each(_outline_of(fields, element), "cornerLocal"))
    if corners:
        return np.array([[fields.number(c, "u"), fields.number(c, "v")] for c in corners])
    if size.radius > 0.0:
        return size.radius * np.stack([np.cos(_ROUND), np.sin(_ROUND)], axis=1)
    box = np.array([[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]])
    return box * np.array([size.length, size.width])


def outline_height(fields: XmlFields, element: Element) -> float:
    """Read the height of an object: its own or that of its highest corner [m]."""
    outline = _outline_of(fields, element)
    corners = [
        corner for tag in ("cornerRoad", "cornerLocal") for corner in fields.each(outline, tag)
    ]
    return max(0.0, *(fields.number(e, "height", 0.0) for e in (element, *corners)))


def counter_clockwise(corners: Corners) -> tuple[tuple[float, float], ...]:
    """Put the corners of an outline in order.

    Args:
        corners: In either order [m].

    Returns:
        The corners, none if they enclose nothing [m].
    """
    centred = corners - corners.mean(axis=0)
    following = np.roll(centred, -1, axis=0)
    area = 0.5 * float(np.sum(centred[:, 0] * following[:, 1] - centred[:, 1] * following[:, 0]))
    if abs(area) < _SMALLEST_AREA:
        return ()
    return tuple((float(x), float(y)) for x, y in (corners if area > 0.0 else corners[::-1]))
