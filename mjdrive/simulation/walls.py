"""The upright sides of a house, to hang windows and doors on."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.town.scenery.blocks import Block


class Wall(NamedTuple):
    """One side of a house.

    Attributes:
        start: Its left end as seen from outside, world frame [m].
        forward: Unit vector from its left to its right end [-].
        width: From end to end [m].
    """

    start: Float[np.ndarray, "2"]
    forward: Float[np.ndarray, "2"]
    width: float

    def panel(
        self, left: float, right: float, bottom: float, top: float, *, proud: float
    ) -> Float[np.ndarray, "4 3"]:
        """Cut a rectangle out of the side.

        Args:
            left: From the left end [m].
            right: From the left end [m].
            bottom: Above the ground [m].
            top: Above the ground [m].
            proud: How far it stands out [m].

        Returns:
            Corners, counter-clockwise from outside, world frame [m].
        """
        outward = np.array([self.forward[1], -self.forward[0]])
        base = self.start + proud * outward
        low, high = base + left * self.forward, base + right * self.forward
        return np.array([[*low, bottom], [*high, bottom], [*high, top], [*low, top]])


def walls_of(block: Block) -> tuple[Wall, ...]:
    """List the sides of a house: its front first, then on counter-clockwise as seen from above."""
    return walls_along(np.roll(block.corners(), -1, axis=0))


def walls_along(outline: Float[np.ndarray, "N 2"]) -> tuple[Wall, ...]:
    """List the sides of a building of any shape.

    Args:
        outline: Ground plan, counter-clockwise, last point not repeated, neighbours distinct, world frame [m].

    Returns:
        A side for each edge, in order.
    """
    closed = np.concatenate([outline, outline[:1]])
    widths = [float(np.hypot(*(end - start))) for start, end in pairwise(closed)]
    return tuple(
        Wall(start, (end - start) / width, width)
        for (start, end), width in zip(pairwise(closed), widths, strict=True)
    )
