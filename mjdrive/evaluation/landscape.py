"""What an energy says of an action: how many separate ways to act there are, and how much each weighs."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

LEAST_MASS = 0.05
"""A basin with less probability than this is a ripple, no way to act [-]."""

DEEPEST = 12.0
"""Actions that are less likely than the best by more than e to this power look alike [nats]."""


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
    comes to the same top belong to one mode. Neighbours that are equally high are one point.

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


def energies(probabilities: Float[np.ndarray, "A S"]) -> Float[np.ndarray, "A S"]:
    """Turn probabilities into energies above the lowest, at most `DEEPEST` [nats]."""
    smallest = probabilities.max() * np.exp(-DEEPEST)
    return np.asarray(np.log(probabilities.max() / np.maximum(probabilities, smallest)))


def _tops(values: Float[np.ndarray, "A S"]) -> Int[np.ndarray, " N"]:
    """The top that one climbs to from each point, by the index of its first point."""
    patch = _patches(values).ravel()
    around = _around(values, fill=-np.inf)
    index = np.arange(values.size)
    neighbour = _around(index.reshape(values.shape), fill=0)
    highest = around.argmax(axis=0)[None]
    height = np.take_along_axis(around, highest, axis=0).ravel()
    onward = np.take_along_axis(neighbour, highest, axis=0).ravel()
    # A patch is left by the highest of all ways out of it.
    way = np.lexsort((-index, height))  # rising, so that the highest is written last
    leaves = np.full(values.size, -1)
    leaves[patch[way]] = patch[onward[way]]
    target = np.where(leaves[patch] >= 0, leaves[patch], patch)
    while not np.array_equal(target[target], target):
        target = target[target]
    return np.asarray(target)


def _patches(values: Float[np.ndarray, "A S"]) -> Int[np.ndarray, "A S"]:
    """The first point of the patch of equally high neighbours that each point belongs to, by index."""
    patch = np.arange(values.size).reshape(values.shape)
    is_level = _around(values, fill=-np.inf) == values
    while True:
        lower = np.where(is_level, _around(patch, fill=values.size), values.size).min(axis=0)
        if np.array_equal(lower, patch):
            return np.asarray(patch)
        patch = lower


def _around(values: np.ndarray, *, fill: float | int) -> np.ndarray:
    """Each point and its eight neighbours, shape (9, A, S); `fill` beyond the edge."""
    height, width = values.shape
    padded = np.pad(values, 1, constant_values=fill)
    return np.stack(
        [
            padded[row : row + height, column : column + width]
            for row in range(3)
            for column in range(3)
        ]
    )
