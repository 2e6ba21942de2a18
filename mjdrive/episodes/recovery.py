"""How often an expert finds back to its route after it was pushed off it: what disturbed demonstrations are to show.

A deviation begins when the car is farther from its route than `OFF_OFFSET`, or more askew to it than `OFF_HEADING`, within
`PUSHED_WITHIN` after a disturbance acted. It is recovered when the car stays within `BACK_OFFSET` and `BACK_HEADING` for
`BACK_FOR`, before it has driven for `TIME_TO_RECOVER` since the last push, and with no infraction on the way. A deviation
in which the drive ends counts neither way.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from mjdrive.datatypes import Episode, Situation
from mjdrive.geometry import wrap_angle
from mjdrive.simulation.simulation import Simulation

DEVIATIONS, RECOVERED = "deviations", "recovered"
"""Under these names `Episode.metadata` holds the figures."""

OFF_OFFSET = 0.7
"""Distance from the route; undisturbed, the PID expert comes to 0.69 m, in the tightest turns of town02 [m]."""

OFF_HEADING = 0.35
"""Angle between car and route; undisturbed, it comes to 0.32 rad [rad]."""

BACK_OFFSET = 0.4
"""Distance from the route [m]."""

BACK_HEADING = 0.15
"""Angle between car and route [rad]."""

BACK_FOR = 0.5
"""How long the car must stay back [s]."""

PUSHED_WITHIN = 2.0
"""A deviation is put down to a disturbance that acted so short a time before [s]."""

TIME_TO_RECOVER = 6.0
"""Time of driving after the last push; standing does not count [s]."""

MOVING_SPEED = 0.1
"""Below this the car stands [m/s]."""


class Recoveries(NamedTuple):
    """What became of the deviations of a drive.

    Attributes:
        deviations: How often the car was pushed off its route [-].
        recovered: How often it found back in time and without an infraction [-].
    """

    deviations: int
    recovered: int


class RouteWatch:
    """A view that takes down how the car lies to its route.

    Args:
        view: What the expert sees.

    Attributes:
        offset: Distance from the route at each look, positive to the left [m].
        heading_error: Heading of the car against the route at each look, positive to the left [rad].
    """

    def __init__(self, view: Callable[[Simulation], Situation]) -> None:
        self._view = view
        self.offset: list[float] = []
        self.heading_error: list[float] = []

    def __call__(self, simulation: Simulation) -> Situation:
        """The truth as an expert sees it."""
        situation = self._view(simulation)
        route = situation.route
        index = int(np.searchsorted(route.station, situation.station))
        along = float(route.yaw[min(index, len(route.yaw) - 1)])
        self.offset.append(situation.offset)
        self.heading_error.append(wrap_angle(situation.vehicle.yaw - along))
        return situation


def recoveries(
    episode: Episode,
    *,
    offset: Float[np.ndarray, " T"],
    heading_error: Float[np.ndarray, " T"],
) -> Recoveries:
    """Count how often a disturbed drive left its route, and how often it found back.

    Args:
        episode: The drive; a disturbance acted where what was driven is not what was wanted.
        offset: Distance of the car from its route at each step, positive to the left [m].
        heading_error: Heading of the car against the route at each step [rad].
    """
    if len(episode.time) < 2:
        return Recoveries(0, 0)
    interval = float(np.median(np.diff(episode.time)))
    is_off = (np.abs(offset) > OFF_OFFSET) | (np.abs(heading_error) > OFF_HEADING)
    pushed = _last(is_pushed(episode), round(PUSHED_WITHIN / interval))
    is_back = _stays(
        (np.abs(offset) < BACK_OFFSET) & (np.abs(heading_error) < BACK_HEADING),
        max(round(BACK_FOR / interval), 1),
    )
    deviations = recovered = 0
    step = 0
    while step < len(is_off):
        if not (is_off[step] and pushed[step]):
            step += 1
            continue
        end, in_time = _end_of_deviation(episode, step, is_back, interval)
        if end is None:
            break
        deviations += 1
        recovered += in_time
        # What was not recovered in time is one deviation still, until the car is back.
        rest = np.flatnonzero(is_back[end:])
        step = end + int(rest[0]) + 1 if len(rest) else len(is_off)
    return Recoveries(deviations, recovered)


def is_pushed(episode: Episode) -> Bool[np.ndarray, " T"]:
    """Whether something else was driven than the expert wanted, step by step."""
    wanted = np.clip(episode.labels, -1.0, 1.0)
    return np.any(np.abs(episode.actions - wanted) > 1e-9, axis=1)


def _end_of_deviation(
    episode: Episode, start: int, is_back: Bool[np.ndarray, " T"], interval: float
) -> tuple[int | None, bool]:
    """Step at which a deviation is decided, and whether the car was back by then; None if the drive ends first."""
    pushed = is_pushed(episode)
    moves = np.abs(episode.vehicle[:, 3]) >= MOVING_SPEED
    breaches = [infraction.time for infraction in episode.infractions]
    left = TIME_TO_RECOVER
    for step in range(start, len(is_back)):
        begun, now = episode.time[start] - 1e-9, episode.time[step] + 1e-9
        if any(begun <= time <= now for time in breaches):
            return step, False
        if is_back[step]:
            return step, True
        left = TIME_TO_RECOVER if pushed[step] else left - interval * bool(moves[step])
        if left < 0:
            return step, False
    return None, False


def _last(flags: Bool[np.ndarray, " T"], steps: int) -> Bool[np.ndarray, " T"]:
    """Whether a flag was up now or within the steps before."""
    total = np.concatenate([[0], np.cumsum(flags)])
    first = np.maximum(np.arange(len(flags)) - steps, 0)
    return total[1:] > total[first]


def _stays(flags: Bool[np.ndarray, " T"], steps: int) -> Bool[np.ndarray, " T"]:
    """Whether a flag has been up for so many steps, this one included."""
    total = np.concatenate([[0], np.cumsum(flags)])
    first = np.maximum(np.arange(len(flags)) - steps + 1, 0)
    return total[1:] - total[first] >= steps
