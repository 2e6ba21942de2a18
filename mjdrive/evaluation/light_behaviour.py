"""What a drive along a route did at each light: whether it stopped when it could, and how soon it started again."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Episode, Route, Signal, Town
from mjdrive.episodes.views import RouteProgress
from mjdrive.expert.reference import StopLine, stop_lines
from mjdrive.town import signals

STANDSTILL_SPEED = 0.1
"""Below this the car stands [m/s] (Leaderboard 1.0)."""

START_REACH = 12.0
"""A car whose nose stands this near before the line when it turns green has waited for it [m]."""


@dataclass(frozen=True, slots=True)
class LightPassage:
    """One stop line on a route, and how it was met.

    Attributes:
        light: Name of the light.
        station: Where the stop line crosses the route [m].
        shown: What the light showed when the nose came over the line.
        braking_needed: What stopping before the line would have taken when the light last turned yellow before that, if
            the car was on its way to it then, without bound in the same control interval [m/s2]; None if the light showed green all the way or the car stood.
        start_delay: Time from the last decision that saw no green to the first at which the car moved, so at most one
            control interval too long [s]; None if the car did not stand before the line when it turned green.
    """

    light: str
    station: float
    shown: Signal
    braking_needed: float | None
    start_delay: float | None


def light_passages(
    episode: Episode, town: Town, route: Route, *, nose_ahead: float
) -> tuple[LightPassage, ...]:
    """Judge every stop line that a drive came over.

    Args:
        episode: The drive.
        town: Where it took place.
        route: What it followed.
        nose_ahead: Distance of the nose ahead of the rear axle [m].

    Returns:
        The stop lines in the order in which they were met.
    """
    follow = RouteProgress(route)
    stations = [follow.look(position).station for position in episode.vehicle[:, :2]]
    nose = np.array(stations) + nose_ahead
    return tuple(
        _passage(episode, town, stop, np.asarray(stop.station - nose))
        for stop in stop_lines(town, route)
        if nose[-1] > stop.station >= nose[0]
    )


def _passage(
    episode: Episode, town: Town, stop: StopLine, to_line: Float[np.ndarray, " T"]
) -> LightPassage:
    """Look back from the step at which the nose came over the line."""
    over = int(np.flatnonzero(to_line < 0.0)[0])
    light, phase = town.lights[stop.light], episode.light_phase
    shown = np.array([signals.at(light, float(time) + phase) for time in episode.time], int)
    speed = np.abs(episode.vehicle[:, 3])
    yellows = np.flatnonzero((shown[1:] == Signal.YELLOW) & (shown[:-1] == Signal.GREEN)) + 1
    greens = np.flatnonzero((shown[1:] == Signal.GREEN) & (shown[:-1] != Signal.GREEN)) + 1
    return LightPassage(
        light=stop.light,
        station=stop.station,
        shown=Signal(int(shown[over])),
        braking_needed=_braking_needed(yellows, speed, to_line, over),
        start_delay=_start_delay(greens, speed, to_line, episode.time),
    )


def _braking_needed(
    yellows: np.ndarray, speed: Float[np.ndarray, " T"], to_line: Float[np.ndarray, " T"], over: int
) -> float | None:
    """Deceleration that the car needed when the light last turned yellow ahead of it [m/s2]."""
    before = yellows[yellows <= over]
    if not len(before) or speed[before[-1]] < STANDSTILL_SPEED:
        return None
    if before[-1] == over:  # it turned yellow in the very interval in which the nose came over
        return math.inf
    return float(speed[before[-1]] ** 2 / (2 * to_line[before[-1]]))


def _start_delay(
    greens: np.ndarray,
    speed: Float[np.ndarray, " T"],
    to_line: Float[np.ndarray, " T"],
    time: Float[np.ndarray, " T"],
) -> float | None:
    """Time that a waiting car took to move [s]."""
    for green in greens:
        if speed[green] < STANDSTILL_SPEED and -1.0 < to_line[green] < START_REACH:
            moving = np.flatnonzero(speed[green:] >= STANDSTILL_SPEED)
            return float(time[green + moving[0]] - time[green - 1]) if len(moving) else np.inf
    return None


def is_rash(passage: LightPassage, *, late_braking: float) -> bool:
    """Whether a car came over a stop line when it should have stopped.

    Args:
        passage: How it met the line.
        late_braking: A yellow is passed when stopping would need more than this [m/s2].
    """
    if passage.shown is Signal.GREEN:
        return False
    needed = passage.braking_needed
    return passage.shown is Signal.RED or needed is None or needed <= late_braking
