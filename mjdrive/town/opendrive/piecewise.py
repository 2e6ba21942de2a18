"""Functions made of pieces, many of them in one table: numpy then works on millions of places, not on dozens."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

SAME_PLACE = 1e-9
"""Distance below which a place counts as the start of the next piece [m]."""


class Piecewise:
    """Several functions of a place along a road, each with one or more pieces.

    Args:
        functions: Numbers of each piece of each function, the place where it starts first [m].
    """

    def __init__(self, functions: Sequence[Sequence[tuple[float, ...]]]) -> None:
        counts = np.array([len(pieces) for pieces in functions], dtype=int)
        self._beyond = np.cumsum(counts)
        self._first = self._beyond - counts
        self._columns = np.array([piece for pieces in functions for piece in pieces]).T.copy()
        self._halvings = int(counts.max(initial=1) - 1).bit_length()

    def find(self, which: Int[np.ndarray, " N"], s: Float[np.ndarray, " N"]) -> np.ndarray:
        """Find the last piece that starts at or before each place, or the first one.

        Args:
            which: Function of each place.
            s: Places [m].

        Returns:
            Numbers of pieces, counted through all functions, shape (N,).
        """
        piece, beyond = self._first[which], self._beyond[which]
        starts = self._columns[0]
        for _ in range(self._halvings):
            middle = (piece + beyond) // 2
            # With one piece left, the middle is that piece.
            is_behind = starts[middle] <= s + SAME_PLACE
            piece = np.where(is_behind, middle, piece)
            beyond = np.where(is_behind, beyond, np.maximum(middle, piece + 1))
        return piece

    def numbers(self, piece: np.ndarray) -> Float[np.ndarray, "C N"]:
        """The numbers of some pieces, one row each."""
        return self._columns[:, piece]
