"""Lines and arcs that join two directed points without a kink."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.road_shapes import Arc, Line, Piece

_KINK = 1e-4
"""Change of heading that counts as none [rad]."""

_SAME_HEADING = 1e-9
"""Lines whose headings differ by less are one line [rad]."""

SLIGHT_BEND_RADIUS = 500.0
"""Radius of bends that nobody notices; far larger ones lose digits in readers with single precision [m]."""

_SHORTEST_LINE = 1e-6
"""Lines below this length are left out [m]."""


class Pose(NamedTuple):
    """A directed point of the plane, world frame.

    Attributes:
        point: Position, shape (2,) [m].
        direction: Unit vector of travel, shape (2,) [-].
    """

    point: Float[np.ndarray, "2"]
    direction: Float[np.ndarray, "2"]

    def to_the_right(self, distance: float) -> "Pose":
        """Shift the pose sideways by a distance [m]."""
        along_x, along_y = self.direction
        return Pose(self.point + distance * np.array([along_y, -along_x]), self.direction)


def join(start: Pose, end: Pose, *, radius: float | None, what: str) -> tuple[Piece, ...]:
    """Join two poses by line, arc and line.

    Args:
        start: Where the path begins.
        end: Where it ends.
        radius: Radius of the arc [m]; None for a slight bend: the largest that fits, up to 500 m.
        what: How an error calls the path.

    Returns:
        Pieces of a reference line that starts at s = 0; lines of no length are left out.

    Raises:
        TownFormatError: If an arc of this radius does not fit between the poses.
    """
    angle = float(
        np.arctan2(_cross(start.direction, end.direction), start.direction @ end.direction)
    )
    gap = end.point - start.point
    if abs(angle) < _KINK:
        return _chain(Pose(start.point, gap), [(float(np.hypot(*gap)), 0.0)])
    lead_in = _cross(gap, end.direction) / np.sin(angle)
    lead_out = _cross(start.direction, gap) / np.sin(angle)
    half_tangent = np.tan(abs(angle) / 2.0)
    largest = min(lead_in, lead_out) / half_tangent
    radius = min(largest, SLIGHT_BEND_RADIUS) if radius is None else radius
    if not 0.0 < radius <= largest + 1e-9:
        raise TownFormatError(
            f"{what} asks for a radius of {radius:.2f} m; expected more than 0 and at most {largest:.2f} m between "
            "its ends. Take a smaller radius or move the ends apart."
        )
    tangent = radius * half_tangent
    return _chain(
        start,
        [
            (lead_in - tangent, 0.0),
            (radius * abs(angle), float(np.copysign(1.0 / radius, angle))),
            (lead_out - tangent, 0.0),
        ],
    )


def turn_left(start: Pose, *, radius: float, angle: float) -> tuple[Piece, ...]:
    """Draw a single arc to the left.

    Args:
        start: Where it begins.
        radius: Its radius [m].
        angle: By how much it turns [rad].

    Returns:
        The arc, as a reference line that starts at s = 0.
    """
    return _chain(start, [(radius * angle, 1.0 / radius)])


def length_of(pieces: tuple[Piece, ...]) -> float:
    """Length of a reference line [m]."""
    return round(sum((piece.length for piece in pieces), 0.0), 9)


def extend(pieces: tuple[Piece, ...], run: tuple[Piece, ...]) -> tuple[Piece, ...]:
    """Lay a run of pieces behind others: their s goes on, and a line that goes straight on is one line."""
    start = length_of(pieces)
    moved = tuple(replace(piece, s=round(start + piece.s, 9)) for piece in run)
    if pieces and _go_straight_on(pieces[-1], moved[0]):
        line = replace(pieces[-1], length=round(pieces[-1].length + moved[0].length, 9))
        return (*pieces[:-1], line, *moved[1:])
    return pieces + moved


def _go_straight_on(before: Piece, behind: Piece) -> bool:
    both_lines = before.shape == behind.shape == Line()
    return both_lines and abs(before.heading - behind.heading) < _SAME_HEADING


def _cross(first: Float[np.ndarray, "2"], second: Float[np.ndarray, "2"]) -> float:
    return float(first[0] * second[1] - first[1] * second[0])


def _chain(start: Pose, stretches: list[tuple[float, float]]) -> tuple[Piece, ...]:
    """Lay stretches (length, curvature) one behind the other; the direction of the start may have any length."""
    s, (x, y) = 0.0, start.point
    heading = float(np.arctan2(start.direction[1], start.direction[0]))
    pieces = []
    for length, curvature in stretches:
        if length < _SHORTEST_LINE:
            continue
        # Rounded to a nanometre: a map file that people can read.
        position = (round(float(s), 9), round(float(x), 9), round(float(y), 9))
        pieces.append(
            Piece(
                *position,
                round(float(heading), 12),
                round(float(length), 9),
                Arc(round(float(curvature), 12)) if curvature else Line(),
            )
        )
        middle = heading + 0.5 * curvature * length
        chord = length * np.sinc(0.5 * curvature * length / np.pi)
        x, y = x + chord * np.cos(middle), y + chord * np.sin(middle)
        s, heading = s + length, heading + curvature * length
    return tuple(pieces)
