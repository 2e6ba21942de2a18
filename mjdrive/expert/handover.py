"""From one controller to another without a jump."""

import math

import numpy as np

from mjdrive.datatypes import Action

HANDOVER_TIME = 0.2
"""Time constant with which the stand-in's own action takes the place of the last one of the other controller [s]."""


class Handover:
    """Lets a stand-in begin where the other controller was.

    Args:
        interval: Time between two decisions [s].
    """

    def __init__(self, interval: float) -> None:
        self._fade = math.exp(-interval / HANDOVER_TIME)
        self._gap = np.zeros(2)

    def forget(self) -> None:
        """Begin anew: the stand-in's action is taken as it is."""
        self._gap = np.zeros(2)

    def watch(self, action: Action, stand_in: Action) -> None:
        """See what was done, and what the stand-in would have done in its place."""
        self._gap = _array(action) - _array(stand_in)

    def take_over(self, stand_in: Action) -> Action:
        """The stand-in's action, nearer to the other controller's the shorter ago that decided."""
        self._gap *= self._fade
        acceleration, steering = np.clip(_array(stand_in) + self._gap, -1.0, 1.0)
        return Action(acceleration=float(acceleration), steering=float(steering))


def _array(action: Action) -> np.ndarray:
    return np.array([action.acceleration, action.steering])
