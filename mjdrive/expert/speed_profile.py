"""The reference of a plan: how far and how fast along a route, second by second."""

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.config import PidConfig
from mjdrive.datatypes import Route, Town

PAST_BEND = 1.0
"""A bend holds the speed down until the rear axle is this far beyond it [m], as in `reference.turn_speed_limit`."""

RECOVERY_BRAKING = 4.0
"""Deceleration of a car that is off its route, until it is slow enough to steer back [m/s2]."""


class Reference(NamedTuple):
    """What a plan should follow, at N + 1 instants or in the N intervals between them.

    Attributes:
        station: Progress along the route, shape (N + 1,) [m].
        speed: Shape (N + 1,) [m/s].
        curvature: Of the route in each interval, positive to the left, shape (N,) [1/m].
        lane_width: At each instant, shape (N + 1,) [m].
    """

    station: Float[np.ndarray, " N+1"]
    speed: Float[np.ndarray, " N+1"]
    curvature: Float[np.ndarray, " N"]
    lane_width: Float[np.ndarray, " N+1"]


def bend_speeds(route: Route, config: PidConfig) -> Float[np.ndarray, " N"]:
    """Speed at which each point of a route is driven, without a look ahead.

    Args:
        route: Path to follow.
        config: Speeds, and what counts as a turn.

    Returns:
        Speed at each point of the route [m/s].
    """
    curvature = np.abs(route.curvature)
    in_turn = np.minimum(
        config.turn_speed,
        np.sqrt(config.lateral_acceleration / np.maximum(curvature, 1e-9)),
    )
    return np.where(curvature > 1 / config.turn_radius, in_turn, config.target_speed)


def speed_limits(
    station: Float[np.ndarray, " N"], speeds: Float[np.ndarray, " N"], *, braking: float
) -> Float[np.ndarray, " N"]:
    """Fastest speed at each point from which every slower point ahead can still be met.

    Args:
        station: Arc length of each point [m].
        speeds: Speed wanted at each point [m/s].
        braking: Deceleration towards slower points [m/s2].

    Returns:
        Speed limit at each point [m/s].
    """
    # The distance to a slower point is the same for all points before it, so running minima of v^2 + 2 b s do.
    energy = speeds**2 + 2 * braking * station
    ahead = np.minimum.accumulate(energy[::-1])[::-1]
    return np.sqrt(np.minimum(ahead - 2 * braking * station, speeds**2))


class SpeedProfile:
    """Where a route allows which speed, and references along it.

    Args:
        town: Where the route lies.
        route: Path to follow.
        config: The law of the road: speeds, and what counts as a turn.
        braking: Deceleration towards slower stretches and stops [m/s2].
        acceleration: Acceleration after them [m/s2].
        max_braking: Deceleration that a late stop may take [m/s2].
    """

    def __init__(
        self,
        town: Town,
        route: Route,
        *,
        config: PidConfig,
        braking: float,
        acceleration: float,
        max_braking: float,
    ) -> None:
        held = bend_speeds(route, config)
        after = np.interp(route.station - PAST_BEND, route.station, held)
        self._limit = speed_limits(route.station, np.minimum(held, after), braking=braking)
        self._route = route
        self._width = np.array([town.lanes[name].width for name in route.lanes])[route.lane_index]
        self._braking = braking
        self._acceleration = acceleration
        self._max_braking = max_braking

    def limit(self, station: float) -> float:
        """Speed limit at a station [m] of the route [m/s]."""
        return float(np.interp(station, self._route.station, self._limit))

    def reference(
        self,
        *,
        station: float,
        speed: float,
        distance_to_stop: float | None,
        cap: float = np.inf,
        num_steps: int,
        interval: float,
    ) -> Reference:
        """Lay a reference ahead of the car, from its present place and speed.

        Args:
            station: Progress of the car along the route [m].
            speed: Of the car [m/s].
            distance_to_stop: How far it may still roll [m], or None if nothing asks it to stop.
            cap: Speed to come down to at once, to steer back to the route [m/s].
            num_steps: Number of intervals N [-].
            interval: Length of one [s].

        Returns:
            Speeds that rise and fall by no more than the limits and stay below the law, and the places that follow.
        """
        stations, speeds = [station], [max(speed, 0.0)]
        stop, braking = self._stop(station, speeds[0], distance_to_stop)
        for _ in range(num_steps):
            here, now = stations[-1], speeds[-1]
            there = here + now * interval
            allowed = min(
                self.limit(there),
                math.sqrt(2 * braking * max(stop - there, 0.0)),
                max(cap, now - RECOVERY_BRAKING * interval),
            )
            following = max(
                min(now + self._acceleration * interval, allowed),
                now - self._max_braking * interval,
                0.0,
            )
            stations.append(here + 0.5 * (now + following) * interval)
            speeds.append(following)
        along = np.array(stations)
        route = self._route
        return Reference(
            station=along,
            speed=np.array(speeds),
            curvature=np.interp(0.5 * (along[1:] + along[:-1]), route.station, route.curvature),
            lane_width=np.interp(along, route.station, self._width),
        )

    def _stop(self, station: float, speed: float, distance: float | None) -> tuple[float, float]:
        """Place to stand at [m] and the even deceleration that leads there [m/s2]."""
        if distance is None:
            return np.inf, self._braking
        needed = speed**2 / (2 * max(distance, 0.05))
        return station + distance, min(max(needed, self._braking), self._max_braking)
