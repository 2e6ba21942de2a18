"""Where the reference line of an OpenDRIVE road runs."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from mjdrive.town.opendrive.curves import arc, curve
from mjdrive.town.opendrive.road_shapes import Arc, Line, Piece

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
    index = piece_index(pieces, s)
    table = np.array([(p.s, p.x, p.y, p.heading, curvature_of(p)) for p in pieces])
    start, x, y, heading, curvature = table[index].T
    # Lines and arcs, of which most roads are made, all at once; the other pieces one by one.
    u, v, turn = arc(curvature, s - start)
    for number, piece in enumerate(pieces):
        if not isinstance(piece.shape, Line | Arc):
            here = index == number
            if here.any():
                u[here], v[here], turn[here] = curve(piece.shape, piece.length, (s - start)[here])
    cos, sin = np.cos(heading), np.sin(heading)
    return np.stack([x + u * cos - v * sin, y + u * sin + v * cos], axis=1), heading + turn


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
