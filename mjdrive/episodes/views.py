"""How a simulation looks to a policy: the bird's-eye view for learned ones, the truth for experts."""

import numpy as np
from jaxtyping import Float

from mjdrive import geometry
from mjdrive.datatypes import Episode, Observation, Route, Situation
from mjdrive.simulation.simulation import Simulation
from mjdrive.town.random_walk import RandomWalk

_SEARCH_AHEAD = 15
"""Route segments, of about 1 m each, in which the car is looked for after one control step."""


def observe(simulation: Simulation) -> Observation:
    """All that a learned policy may see."""
    return simulation.observe()


def states(episode: Episode) -> Float[np.ndarray, "T 3"]:
    """The state part of each observation: speed [m/s], previous acceleration and previous steering [-]."""
    previous = np.vstack([np.zeros((1, 2)), episode.actions[:-1]])
    return np.column_stack([episode.vehicle[:, 3], previous]).astype(np.float32)


class RouteProgress:
    """Finds a car on its route again and again; the route may cross itself.

    Args:
        route: Path to follow; the car starts at its beginning.

    Attributes:
        route: The path.
        station: Where the car was when it was last looked for [m].
    """

    def __init__(self, route: Route) -> None:
        self.route = route
        self.station = float(route.station[0])
        self._segment = 0

    def look(self, position: Float[np.ndarray, "2"]) -> geometry.Projection:
        """Project a place, not far from the last one, onto the route.

        Args:
            position: Rear axle of the car, world frame [m].
        """
        seen = geometry.project(
            self.route.points,
            position,
            first_segment=max(self._segment - 2, 0),
            last_segment=self._segment + _SEARCH_AHEAD,
        )
        self._segment = seen.segment
        self.station = float(self.route.station[0]) + seen.station
        return seen._replace(station=self.station)

    def go_over_to(self, route: Route) -> None:
        """Follow another piece of the same line from now on; points that both have are at equal stations."""
        self._segment -= int(np.searchsorted(self.route.station, route.station[0]))
        self.route = route


class FollowRoute(RouteProgress):
    """Follows the progress of a car along one route, which may cross itself.

    Args:
        route: Path to follow; the car starts at its beginning.
    """

    def __call__(self, simulation: Simulation) -> Situation:
        """The truth as an expert sees it."""
        vehicle = simulation.vehicle
        seen = self.look(np.array([vehicle.x, vehicle.y]))
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


class FollowWalk:
    """Follows the progress of a car along a random walk, which is laid on as the car drives.

    Args:
        walk: What to follow; the car starts at its beginning.
    """

    def __init__(self, walk: RandomWalk) -> None:
        self._walk = walk
        self._follow = FollowRoute(walk.route)

    def __call__(self, simulation: Simulation) -> Situation:
        """The truth as an expert sees it."""
        self._walk.advance(self._follow.station)
        if self._walk.route is not self._follow.route:
            self._follow.go_over_to(self._walk.route)
        return self._follow(simulation)

    @property
    def station(self) -> float:
        """How far along the walk the car was when it was last looked at [m]."""
        return self._follow.station
