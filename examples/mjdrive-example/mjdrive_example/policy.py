"""A policy without learning: it keeps the middle of the lane that it sees, and stops for nothing."""

import numpy as np

from mjdrive.bev.layers import Layer
from mjdrive.config import BevConfig
from mjdrive.datatypes import Action, Observation

SPEED = 4.0
"""How fast it drives [m/s]."""

AHEAD = 6.0
"""How far ahead it looks [m]."""

LANE_WIDTH = 4.0
"""It keeps half of this from the right edge of the road [m]."""


class KerbFollower:
    """Follows the right edge of the road."""

    name = "example-policy"

    def reset(self, seed: int) -> None:
        """Nothing is remembered, and nothing is left to chance."""

    def act(self, view: Observation) -> Action:
        """Steer towards the middle of the right lane.

        Args:
            view: What a learned policy may see.
        """
        speed = float(view.state[0])
        return Action(
            acceleration=float(np.clip(0.5 * (SPEED - speed), -1.0, 0.5)),
            steering=float(np.clip(0.3 * _to_the_left(view), -1.0, 1.0)),
        )


def _to_the_left(view: Observation) -> float:
    """How far the middle of the right lane lies to the left of the car, some metres ahead [m]."""
    config = BevConfig()
    row = config.size_px - config.ego_above_bottom_px - round(AHEAD * config.pixels_per_metre)
    middle = config.size_px // 2
    off_road = np.flatnonzero(view.bev[Layer.ROAD][row, middle:] == 0)
    if len(off_road) == 0:
        return 0.0  # a junction: straight on
    to_edge = off_road[0] / config.pixels_per_metre
    return LANE_WIDTH / 2 - to_edge if to_edge < LANE_WIDTH else 0.0
