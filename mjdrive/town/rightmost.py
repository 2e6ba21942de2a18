"""The way farthest to the right: what a driver takes who never makes a choice."""

import math
from collections.abc import Sequence

from mjdrive.datatypes import Lane, Town
from mjdrive.geometry import headings, wrap_angle


def rightmost(town: Town, ways: Sequence[str]) -> str:
    """Name the one of several lanes from a common start that turns farthest to the right.

    Args:
        town: Where they lie.
        ways: Their names, at least one; the first of two that turn alike is taken.
    """
    return min(ways, key=lambda name: _turned(town.lanes[name]))


def _turned(lane: Lane) -> float:
    """How far a lane turns from its start to its end, positive to the left [rad]."""
    yaw = headings(lane.centerline)
    turned = wrap_angle(float(yaw[-1] - yaw[0]))
    assert math.isfinite(turned), "a lane has a direction"
    return turned
