"""Tells at once that a car is still well inside its lane, without a look at the lanes around it.

Most steps of most drives are of this kind, and what the rules ask for then follows from it. Where it is not certain
the answer is no, and the whole `LaneIndex` has to be asked.
"""

import math

from mjdrive.town.lane_index import LaneIndex, LanePlace, Segment

MARGIN = 0.3
"""From the edges of the lane; how outlines of lanes are cut and joined changes them by less [m]."""

LEAST_COSINE = 0.5
"""Between the headings of car and lane: more than half a right angle off is not certain [-]."""

_MOST_HOPS = 4
"""Segments to go on by in one look [-]."""


class Foothold:
    """The segment of a lane under a car, carried along as it drives.

    Args:
        index: Lanes of the town.
    """

    def __init__(self, index: LaneIndex) -> None:
        self._index = index
        self._segment: Segment | None = None

    def holds(self, x: float, y: float, yaw: float) -> bool:
        """Whether a point certainly lies on the lane that it was last found on.

        Args:
            x: World frame [m].
            y: World frame [m].
            yaw: Heading of the car, which has to follow the lane [rad].

        Returns:
            True if it does: between both edges and away from them, along the lane and heading with it. False if it
            may not.
        """
        segment = self._segment
        for _ in range(_MOST_HOPS):
            if segment is None:
                return False
            along = segment.cos * x + segment.sin * y + segment.along_offset
            if along <= segment.length:
                break
            segment = self._segment = self._index.segment_after(segment)
        else:
            return False
        left = segment.cos * y - segment.sin * x + segment.left_offset
        return (
            along >= 0.0
            and abs(left) <= segment.half_width - MARGIN
            and math.cos(yaw - segment.yaw) >= LEAST_COSINE
        )

    def set_on(self, place: LanePlace) -> None:
        """Begin at a place on a lane."""
        self._segment = self._index.segment_at(place)
