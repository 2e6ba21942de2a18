"""Where the reference lines of OpenDRIVE roads run."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from mjdrive.town.opendrive.curves import arc, curve
from mjdrive.town.opendrive.piecewise import Piecewise
from mjdrive.town.opendrive.road_map import Road
from mjdrive.town.opendrive.road_shapes import Arc, Line, Piece


class ReferenceLines:
    """The reference lines of several roads.

    Args:
        roads: Pieces of each, in order.
    """

    def __init__(self, roads: Sequence[Sequence[Piece]]) -> None:
        self._pieces = [piece for pieces in roads for piece in pieces]
        self._table = Piecewise(
            [[(p.s, p.x, p.y, p.heading, curvature_of(p)) for p in pieces] for pieces in roads]
        )
        self._is_other = np.array([not isinstance(p.shape, Line | Arc) for p in self._pieces])

    def at(
        self, which: Int[np.ndarray, " N"], s: Float[np.ndarray, " N"]
    ) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, " N"]]:
        """Evaluate them; a place between two pieces belongs to the later one.

        Args:
            which: Number of the road of each place.
            s: Where along it [m].

        Returns:
            Points in the world frame, shape (N, 2) [m], and headings, shape (N,) [rad].
        """
        number = self._table.find(which, s)
        start, x, y, heading, curvature = self._table.numbers(number)
        along = s - start
        # Lines and arcs, of which most roads are made, all at once; the other pieces one by one.
        u, v, turn = arc(curvature, along)
        others = np.flatnonzero(self._is_other[number])
        others = others[np.argsort(number[others], kind="stable")]
        for here in np.split(others, np.flatnonzero(np.diff(number[others])) + 1):
            if len(here):
                piece = self._pieces[number[here[0]]]
                u[here], v[here], turn[here] = curve(piece.shape, piece.length, along[here])
        cos, sin = np.cos(heading), np.sin(heading)
        return np.stack([x + u * cos - v * sin, y + u * sin + v * cos], axis=1), heading + turn


def reference_line(
    pieces: Sequence[Piece], s: Float[np.ndarray, " N"]
) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, " N"]]:
    """Evaluate the reference line of one road.

    Args:
        pieces: Its pieces in order.
        s: Where along the road [m].

    Returns:
        Points in the world frame, shape (N, 2) [m], and headings, shape (N,) [rad].
    """
    return ReferenceLines([pieces]).at(np.zeros(len(s), dtype=int), s)


def places_beside(
    places: Sequence[tuple[Road, float, float]],
) -> tuple[Float[np.ndarray, "N 2"], Float[np.ndarray, " N"]]:
    """Find places beside roads.

    Args:
        places: Road, s along it and t across it, positive to the left [m].

    Returns:
        Points in the world frame, shape (N, 2) [m], and headings of the roads there, shape (N,) [rad].
    """
    if not places:
        return np.zeros((0, 2)), np.zeros(0)
    roads, s, t = zip(*places, strict=True)
    points, heading = ReferenceLines([road.pieces for road in roads]).at(
        np.arange(len(roads)), np.array(s)
    )
    across = np.stack([-np.sin(heading), np.cos(heading)], axis=1)
    return points + np.array(t)[:, None] * across, heading


def curvature_of(piece: Piece) -> float:
    """Curvature of a line or an arc, 0 for any other shape [1/m]."""
    return piece.shape.curvature if isinstance(piece.shape, Arc) else 0.0
