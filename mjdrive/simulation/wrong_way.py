"""Wrong way: driving on a lane against its direction."""

import math

from mjdrive.config import RulesConfig
from mjdrive.town.lane_index import LaneIndex, LanePlace


class WrongWayWatch:
    """Watches whether the car drives against its lane.

    A lane fits while the heading is within `wrong_way_angle` of its direction. The car is against the traffic while
    its centre lies on one or more lanes of which none fits; it drives the wrong way once it has covered
    `wrong_way_distance` so. That counts once, until the car is on a lane that fits; metres off the lanes do
    not count, but do not end it either.

    Args:
        index: Lanes of the town.
        config: Limits of the rules.
    """

    def __init__(self, index: LaneIndex, config: RulesConfig) -> None:
        self._index = index
        self._config = config
        self._least_cosine = math.cos(config.wrong_way_angle)
        self.reset()

    def reset(self) -> None:
        """Forget the drive so far."""
        self._distance = 0.0
        self._has_counted = False
        self._against_at: tuple[float, float] | None = None

    def check(self, centre: tuple[float, float], yaw: float) -> str | None:
        """Judge one control step.

        Args:
            centre: Centre of the footprint, world frame [m].
            yaw: Heading of the car [rad].

        Returns:
            Name of the lane that the car drives against, if that is new.
        """
        places = self._index.under(*centre)
        if any(math.cos(yaw - place.yaw) >= self._least_cosine for place in places):
            self.reset()
            return None
        if not places:
            self._against_at = None
            return None
        if self._against_at is not None:
            self._distance += math.dist(self._against_at, centre)
        self._against_at = centre
        if self._has_counted or self._distance < self._config.wrong_way_distance:
            return None
        self._has_counted = True
        return min(places, key=_distance_from_middle).lane


def _distance_from_middle(place: LanePlace) -> float:
    """Distance from the centre line [m]."""
    return abs(place.offset)
