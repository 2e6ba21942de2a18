"""A route without end: it is laid as it is driven, and forgotten behind the car."""

import math

import numpy as np

from mjdrive.datatypes import Route, Town
from mjdrive.geometry import curvatures, headings, stations
from mjdrive.town.lane_graph import onward
from mjdrive.town.random_lanes import Choose, random_lanes
from mjdrive.town.route_line import POINT_SPACING

AHEAD = 150.0
"""The route is known at least so far ahead of the car, where the lanes lead on [m]."""

STRETCH = 300.0
"""When it is laid on, then so far beyond that, so that experts do not meet a new route too often [m]."""

BEHIND = 20.0
"""It is kept at least so far behind the car [m]."""


class RandomWalk:
    """A window on an endless route that takes each way at a junction with the same probability.

    Ways that come to a dead end are left out where others lead on for ever; where none does, those that end before
    `length`. The route of a window is a piece of one and the same line: points and stations that two windows share are
    equal.

    Args:
        town: The town.
        lane: Name of the lane to start on.
        station: Where on it to start [m].
        rng: Source of the choices.
        length: How far it must lead at least where no way leads on for ever [m]; no less than two points are apart.
        choose: Chooses among the ways on instead of chance.

    Attributes:
        route: The window now; its first station is that of its first point along the walk.

    Raises:
        UnknownNameError: If there is no such lane.
        RouteError: If the station is not on the lane, or every way comes to a dead end before that length.
    """

    def __init__(
        self,
        town: Town,
        *,
        lane: str,
        station: float,
        rng: np.random.Generator,
        length: float = 2 * POINT_SPACING,
        choose: Choose | None = None,
    ) -> None:
        self._town = town
        if math.isinf(onward(town).get(lane, 0.0)):
            length = math.inf  # the same walk whatever is asked of it
        self._coming = random_lanes(
            town, lane=lane, station=station, length=length, rng=rng, choose=choose
        )
        line = town.lanes[next(self._coming)].centerline
        along = stations(line)
        start = np.array([np.interp(station, along, line[:, axis]) for axis in (0, 1)])
        self._lanes = [lane]
        self._first = 0
        self._points = start[None]
        self._lane_index = np.zeros(1, int)
        self._rest = np.concatenate([start[None], line[along > station + 1e-9]])
        self._is_ended = False
        self._lay(0)
        self._lay_on(0.0)

    def advance(self, station: float) -> None:
        """Lay the route on ahead of the car and forget it behind; `route` is a new one if that changed it.

        Args:
            station: Where the car is along the walk [m].
        """
        if not self._is_ended and self._end < station + AHEAD:
            self._lay_on(station)

    def _lay_on(self, station: float) -> None:
        """Lay the route on beyond what must be known ahead, and make a window of it."""
        while not self._is_ended and self._end < station + AHEAD + STRETCH:
            name = next(self._coming, None)
            if name is None:
                self._is_ended = True
            else:
                self._rest = np.concatenate([self._rest, self._town.lanes[name].centerline[1:]])
                self._lanes.append(name)
                self._lay(len(self._lanes) - 1)
        self._forget(station - BEHIND)
        self.route = Route(
            lanes=tuple(self._lanes),
            points=self._points,
            station=POINT_SPACING * (self._first + np.arange(len(self._points))),
            yaw=headings(self._points),
            curvature=curvatures(self._points),
            lane_index=self._lane_index,
        )

    @property
    def _end(self) -> float:
        """Station of the last point laid [m]."""
        return POINT_SPACING * (self._first + len(self._points) - 1)

    def _lay(self, lane_index: int) -> None:
        """Lay points along the rest of the line; what is left of it is shorter than the distance of two points."""
        along = stations(self._rest)
        wanted = np.arange(POINT_SPACING, along[-1] + 1e-9, POINT_SPACING)
        if not len(wanted):
            return
        laid = np.stack([np.interp(wanted, along, self._rest[:, axis]) for axis in (0, 1)], axis=1)
        self._rest = np.concatenate([laid[-1:], self._rest[along > wanted[-1] + 1e-9]])
        self._points = np.concatenate([self._points, laid])
        self._lane_index = np.append(self._lane_index, np.full(len(laid), lane_index))

    def _forget(self, station: float) -> None:
        """Drop the points, and the lanes that lost all of them, before a station [m]."""
        drop = max(math.floor(station / POINT_SPACING) - self._first, 0)
        self._first += drop
        self._points, self._lane_index = self._points[drop:], self._lane_index[drop:]
        gone = int(self._lane_index[0])
        self._lanes, self._lane_index = self._lanes[gone:], self._lane_index - gone
