"""Wrong way: driving on a lane against its direction."""

import math

from mjdrive.config import RulesConfig
from mjdrive.town.foothold import LEAST_COSINE, Foothold
from mjdrive.town.lane_index import LaneIndex, LanePlace

Point = tuple[float, float]


class WrongWayWatch:
    """Watches whether the car drives against its lane.

    A lane fits while the heading is within `wrong_way_angle` of its direction. The car is against the traffic while
    its centre lies on one or more lanes of which none fits. Once it has covered `wrong_way_distance` so, without a
    lane that fits in between, it drives the wrong way; that is over, and can count again, once it has covered as much
    on lanes that fit. Metres off the lanes belong to neither.

    Args:
        index: Lanes of the town.
        foothold: Is set on the lane that fits, to know the next places on it at once.
        config: Limits of the rules.
    """

    def __init__(self, index: LaneIndex, foothold: Foothold, config: RulesConfig) -> None:
        self._index = index
        self._foothold = foothold
        self._limit = config.wrong_way_distance
        self._least_cosine = math.cos(config.wrong_way_angle)
        self.reset()

    def reset(self) -> None:
        """Forget the drive so far."""
        self._is_wrong = False
        self._distance = 0.0
        self._before: Point | None = None

    def check(self, centre: Point, yaw: float, *, in_lane: bool = False) -> str | None:
        """Judge one control step.

        Args:
            centre: Centre of the footprint, world frame [m].
            yaw: Heading of the car [rad].
            in_lane: Whether it is known to lie well inside a lane and to follow it.

        Returns:
            Name of the lane that the car drives against, if that is new.
        """
        if in_lane and not self._is_wrong and self._least_cosine <= LEAST_COSINE:
            self._before, self._distance = None, 0.0
            return None
        places = self._index.under(*centre)
        fitting = [it for it in places if math.cos(yaw - it.yaw) >= self._least_cosine]
        fits = bool(fitting)
        if fits:
            self._foothold.set_on(fitting[0])
        if not places or fits is not self._is_wrong:
            self._before = None
            if places:
                self._distance = 0.0
            return None
        if self._before is not None:
            self._distance += math.dist(self._before, centre)
        self._before = centre
        if self._distance < self._limit:
            return None
        self.reset()
        self._is_wrong = not fits
        return min(places, key=_distance_from_middle).lane if self._is_wrong else None


def _distance_from_middle(place: LanePlace) -> float:
    """Distance from the centre line [m]."""
    return abs(place.offset)
