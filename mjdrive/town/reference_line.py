"""Where the reference line of an OpenDRIVE road runs."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mjdrive.town.curves import curve
from mjdrive.town.road_shapes import Arc, Piece

_SAME_PLACE = 1e-9
"""Distance below which a station counts as the start of the next piece or cubic [m]."""


def reference_line(
    pieces: Sequence[Piece], s: Float[np.ndarray, " N"]
) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, " N"]]:
    """Evaluate the reference line of a road.

    Args:
        pieces: Its pieces in order.
        s: Where along the road [m].

    Returns:
        Points in the world frame, shape (N, 2) [m], and headings, shape (N,) [rad].
    """
    points, heading = np.empty((len(s), 2)), np.empty(len(s))
    index = piece_index(pieces, s)
    for number in np.unique(index):
        piece = pieces[number]
        here = index == number
        u, v, turn = curve(piece.shape, piece.length, s[here] - piece.s)
        cos, sin = np.cos(piece.heading), np.sin(piece.heading)
        points[here, 0] = piece.x + u * cos - v * sin
        points[here, 1] = piece.y + u * sin + v * cos
        heading[here] = piece.heading + turn
    return points, heading


def piece_index(pieces: Sequence[Piece], s: Float[np.ndarray, " N"]) -> np.ndarray:
    """Find the piece at each station; a place between two belongs to the later one.

    Args:
        pieces: Pieces in order.
        s: Where along the road [m].

    Returns:
        Index into `pieces` for each station, shape (N,).
    """
    starts = np.array([piece.s for piece in pieces])
    return np.clip(np.searchsorted(starts, s + _SAME_PLACE, side="right") - 1, 0, None)


def curvature_of(piece: Piece) -> float:
    """Curvature of a line or an arc, 0 for any other shape [1/m]."""
    return piece.shape.curvature if isinstance(piece.shape, Arc) else 0.0
