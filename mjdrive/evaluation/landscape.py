"""What an energy says of an action: how many separate ways to act there are, and how much each weighs."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

LEAST_MASS = 0.05
"""A basin with less probability than this is a ripple, no way to act [-]."""


class Mode(NamedTuple):
    """A separate way to act.

    Attributes:
        acceleration: Of its most probable action [-].
        steering: Of its most probable action [-].
        mass: Probability of all actions from which one climbs to that one [-].
    """

    acceleration: float
    steering: float
    mass: float


def modes(
    probabilities: Float[np.ndarray, "A S"], *, least_mass: float = LEAST_MASS
) -> tuple[Mode, ...]:
    """Find the separate ways to act in a distribution over a grid of actions.

    From each point one climbs to the highest of its eight neighbours until there is none higher; points from which one
    comes to the same top belong to one mode.

    Args:
        probabilities: Of the points of an even grid over [-1, 1] x [-1, 1], acceleration outermost; they sum to one [-].
        least_mass: Modes of less are left out [-].

    Returns:
        The modes, the heaviest first.
    """
    top = _tops(probabilities)
    mass = np.bincount(top, weights=probabilities.ravel(), minlength=probabilities.size)
    heavy = np.flatnonzero(mass >= least_mass)
    axes = [np.linspace(-1.0, 1.0, points) for points in probabilities.shape]
    rows, columns = np.unravel_index(heavy, probabilities.shape)
    found = [
        Mode(float(axes[0][row]), float(axes[1][column]), float(mass[index]))
        for row, column, index in zip(rows, columns, heavy, strict=True)
    ]
    return tuple(sorted(found, key=lambda mode: -mode.mass))


def entropy_bits(probabilities: Float[np.ndarray, "A S"]) -> float:
    """Entropy of a distribution over a grid; at most the logarithm of its number of points [bit]."""
    positive = probabilities[probabilities > 0]
    return float(-np.sum(positive * np.log2(positive)))


def _tops(values: Float[np.ndarray, "A S"]) -> Int[np.ndarray, " N"]:
    """The point that one climbs to from each point, by index."""
    height, width = values.shape
    padded = np.pad(values, 1, constant_values=-np.inf)
    offsets = [(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1)]
    # The point itself comes first, so that who is as high as its neighbours stays.
    offsets.sort(key=lambda offset: offset != (0, 0))
    around = np.stack([padded[1 + r : 1 + r + height, 1 + c : 1 + c + width] for r, c in offsets])
    steps = np.array([r * width + c for r, c in offsets])
    target = np.arange(values.size) + steps[around.argmax(axis=0).ravel()]
    while True:
        farther = target[target]
        if np.array_equal(farther, target):
            return np.asarray(target)
        target = farther
