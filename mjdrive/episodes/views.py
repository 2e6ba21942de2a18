"""How a simulation looks to a policy: the bird's-eye view for learned ones, the truth for experts."""

import numpy as np

from mjdrive import geometry
from mjdrive.datatypes import Observation, Route, Situation
from mjdrive.simulation.simulation import Simulation

_SEARCH_AHEAD = 15
"""Route segments, of about 1 m each, in which the car is looked for after one control step."""


def observe(simulation: Simulation) -> Observation:
    """All that a learned policy may see."""
    return simulation.observe()


class FollowRoute:
    """Follows the progress of a car along one route, which may cross itself.

    Args:
        route: Path to follow; the car starts at its beginning.
    """

    def __init__(self, route: Route) -> None:
        self.route = route
        self.station = 0.0
        self._segment = 0

    def __call__(self, simulation: Simulation) -> Situation:
        """The truth as an expert sees it."""
        vehicle = simulation.vehicle
        seen = geometry.project(
            self.route.points,
            np.array([vehicle.x, vehicle.y]),
            first_segment=max(self._segment - 2, 0),
            last_segment=self._segment + _SEARCH_AHEAD,
        )
        self._segment, self.station = seen.segment, seen.station
        return Situation(
            time=simulation.time,
            vehicle=vehicle,
            route=self.route,
            station=seen.station,
            offset=seen.offset,
            lights=simulation.lights,
        )

    @property
    def is_finished(self) -> bool:
        """Whether the car is within 3 m of the end of the route."""
        return bool(self.route.station[-1] - self.station < 3.0)
