"""How tightly lanes bend."""

from collections.abc import Iterator

import numpy as np

from mjdrive.datatypes import Lane, Town
from mjdrive.geometry import curvatures, resample, stations

_PIECE = 0.5
"""Shortest stretch over which a bend is measured, so that no short step makes one of rounding [m]."""


def tight_turns(town: Town, radius: float) -> Iterator[tuple[Lane, float]]:
    """Find the lanes whose centre line bends more tightly than a circle.

    Args:
        town: The town.
        radius: Of the circle, 1 m or more [m].

    Yields:
        Each lane and its smallest radius over about a metre [m].
    """
    lanes = list(town.lanes.values())
    # Between two stretches a lane cannot turn by more than it does as a whole; most turn too little.
    for number in np.flatnonzero(_turns(lanes) > 0.9 * _PIECE / radius):
        smallest = _smallest_radius(lanes[number])
        if smallest < radius:
            yield lanes[number], smallest


def _turns(lanes: list[Lane]) -> np.ndarray:
    """By how much each lane turns, to the left and to the right together [rad]."""
    points = np.concatenate([lane.centerline for lane in lanes])
    which = np.repeat(np.arange(len(lanes)), [len(lane.centerline) for lane in lanes])
    step = np.diff(points, axis=0)
    turn = np.diff(np.arctan2(step[:, 1], step[:, 0]))
    turn = np.abs((turn + np.pi) % (2.0 * np.pi) - np.pi)
    return np.bincount(which[2:], np.where(which[2:] == which[:-2], turn, 0.0), len(lanes))


def _smallest_radius(lane: Lane) -> float:
    """Smallest radius of the centre line; infinite where it is straight [m]."""
    length = stations(lane.centerline)[-1]
    pieces = int(length / _PIECE)
    if pieces < 2:
        return np.inf
    curvature = np.abs(curvatures(resample(lane.centerline, length / pieces))).max()
    return np.inf if curvature == 0.0 else float(1.0 / curvature)
