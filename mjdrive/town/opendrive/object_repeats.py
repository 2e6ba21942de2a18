"""Read objects that repeat along a road: rows of trees, lamps, and barriers without end."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from mjdrive.geometry import world_from_vehicle
from mjdrive.town.opendrive.object_outlines import Size, counter_clockwise, local_corners, place
from mjdrive.town.opendrive.road_map import ObjectRecord
from mjdrive.town.opendrive.road_shapes import Piece
from mjdrive.town.opendrive.xml_fields import Element, XmlFields

MOST_COPIES = 10_000
"""Largest number of copies of one object."""

_STRIP_STEP = 1.0
"""Distance between the corners of an object without gaps, along the road [m]."""


def read_repeats(
    fields: XmlFields,
    element: Element,
    thing: ObjectRecord,
    size: Size,
    *,
    length: float,
    pieces: Sequence[Piece],
) -> Iterator[ObjectRecord]:
    """Read the copies of an object; they take the place of the object itself.

    Args:
        fields: Takes values out of the document.
        element: The object.
        thing: What was read of it.
        size: Its size.
        length: Length of the road [m].
        pieces: Its reference line.

    Yields:
        The copies, named after the object; one without gaps is a single long one.

    Raises:
        TownFormatError: If a value is missing or is no number, or the copies are too many.
    """
    for order, repeat in enumerate(fields.each(element, "repeat")):
        start = min(max(fields.number(repeat, "s"), 0.0), length)
        span = min(max(fields.number(repeat, "length"), 0.0), length - start)
        distance = fields.number(repeat, "distance")
        copy = replace(thing, id=f"{thing.id}/{order}")
        along = _values(fields, repeat, size, thing)
        if distance <= 0.0:
            yield _strip(copy, start, span, along, pieces)
            continue
        if span / distance > MOST_COPIES:
            fields.fail(
                repeat, f"makes {span / distance:.0f} copies; expected at most {MOST_COPIES}."
            )
        for number in range(int(span / distance + 1e-9) + 1):
            share = number * distance / span if span else 0.0
            t, height, *sizes = (value(share) for value in along)
            s = start + number * distance
            (x, y), yaw = place(pieces, s, t)
            corners = world_from_vehicle(
                local_corners(fields, element, Size(*sizes)), x=x, y=y, yaw=yaw + thing.heading
            )
            yield replace(
                copy,
                id=f"{copy.id}/{number}",
                s=s,
                t=t,
                height=max(height, 0.0),
                outline=counter_clockwise(corners),
            )


def _values(
    fields: XmlFields, repeat: Element, size: Size, thing: ObjectRecord
) -> list[Callable[[float], float]]:
    """How t, height, length, width and radius change over the share of the way, from 0 to 1 [m]."""
    usual = {
        "t": thing.t,
        "height": thing.height,
        "length": size.length,
        "width": size.width,
        "radius": size.radius,
    }

    def line(name: str, default: float) -> Callable[[float], float]:
        first = fields.number(repeat, f"{name}Start", default)
        last = fields.number(repeat, f"{name}End", first)
        return lambda share: first + share * (last - first)

    return [line(name, default) for name, default in usual.items()]


def _strip(
    copy: ObjectRecord,
    start: float,
    span: float,
    along: Sequence[Callable[[float], float]],
    pieces: Sequence[Piece],
) -> ObjectRecord:
    """One object from the start of the repetition to its end."""
    t_at, height_at, _, width_at, radius_at = along
    shares = np.linspace(0.0, 1.0, int(np.ceil(span / _STRIP_STEP)) + 1).tolist()
    sides: list[list[tuple[float, float]]] = []
    for side in (-0.5, 0.5):
        offsets = [
            t_at(share) + side * (width_at(share) or 2.0 * radius_at(share)) for share in shares
        ]
        sides.append(
            [
                place(pieces, start + share * span, t)[0]
                for share, t in zip(shares, offsets, strict=True)
            ]
        )
    outline = counter_clockwise(np.array([*sides[0], *sides[1][::-1]]))
    height = max(height_at(0.0), height_at(1.0), 0.0)
    return replace(copy, s=start, t=t_at(0.0), height=height, outline=outline)
