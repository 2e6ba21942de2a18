"""What an expert wants: where the route goes, how fast it may be driven, and where it must stop."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.config import PidConfig
from mjdrive.datatypes import Route, Signal, Situation, Town, TrafficLight
from mjdrive.errors import RouteError
from mjdrive.town import signals


class StopLine(NamedTuple):
    """A light on the route.

    Attributes:
        station: Where its stop line crosses the route [m].
        light: Name of the light.
    """

    station: float
    light: str


class Stop(NamedTuple):
    """Where the car must stand.

    Attributes:
        light: Name of the light that asks for it.
        distance: How far the car may still roll, less than 0 if it is too far already [m].
    """

    light: str
    distance: float


def stop_lines(town: Town, route: Route) -> tuple[StopLine, ...]:
    """Find the lights along a route.

    Args:
        town: Where the route lies.
        route: Path to follow.

    Returns:
        Stop lines in the order in which they are met; a lane that the route leaves before its end has none.
    """
    found = []
    for index, name in enumerate(route.lanes[:-1]):
        light = town.lanes[name].light
        if light is not None:
            # A lane that is shorter than the distance of two points may have none.
            last = max(int(np.searchsorted(route.lane_index, index, side="right")) - 1, 0)
            following = min(last + 1, len(route.station) - 1)
            middle = town.lights[light].stop_line.mean(axis=0)
            past = np.hypot(*(route.points[last] - middle))
            found.append(
                StopLine(float(min(route.station[last] + past, route.station[following])), light)
            )
    return tuple(found)


def require_green(lights: Iterable[TrafficLight]) -> None:
    """Refuse lights that an expert would wait at for ever.

    Args:
        lights: Those that a drive may come to.

    Raises:
        RouteError: If one of them never turns green.
    """
    for light in lights:
        if not signals.turns_green(light):
            raise RouteError(
                f"Light '{light.id}' at the end of lane '{light.lane}' never turns green (it shows {signals.in_words(light)}), so the expert "
                f"would wait there for ever. Expected a green that lasts: see 'lights' in town.json, or drive elsewhere."
            )


def point_ahead(route: Route, station: float) -> Float[np.ndarray, "2"]:
    """World point of a route at a station [m]; the end of the route beyond it."""
    return np.array([np.interp(station, route.station, route.points[:, axis]) for axis in (0, 1)])


def turn_speed_limit(situation: Situation, config: PidConfig) -> float:
    """Fastest speed from which every bend ahead can still be met at its own speed.

    Args:
        situation: Where the car is on its route.
        config: Speeds, braking and what counts as a turn.

    Returns:
        Speed limit here [m/s].
    """
    route = situation.route
    ahead = route.station - situation.station
    curvature = np.abs(route.curvature)
    horizon = config.target_speed**2 / (2 * config.braking)
    is_turn = (ahead >= -1.0) & (ahead <= horizon) & (curvature > 1 / config.turn_radius)
    if not is_turn.any():
        return config.target_speed
    in_turn = np.minimum(
        config.turn_speed, np.sqrt(config.lateral_acceleration / curvature[is_turn])
    )
    here = np.sqrt(in_turn**2 + 2 * config.braking * np.maximum(ahead[is_turn], 0.0))
    return float(min(here.min(), config.target_speed))


def stop_ahead(
    situation: Situation,
    stops: tuple[StopLine, ...],
    *,
    nose_ahead: float,
    config: PidConfig,
    stopping_for: str = "",
) -> Stop | None:
    """Find where the car must stand.

    A red light is stopped for however late it is; a yellow one unless that takes hard braking. Who has begun to stop
    for a yellow light goes on, even if it has since become harder.

    Args:
        situation: Where the car is on its route, and the lights.
        stops: Lights on the route.
        nose_ahead: Distance of the nose ahead of the rear axle [m].
        config: Gap to keep, and which late yellow is passed.
        stopping_for: Name of the light that the car has begun to stop for, if any.

    Returns:
        The stop, or None if nothing ahead asks for one.
    """
    nose = situation.station + nose_ahead
    for stop in stops:
        # A nose just over the line still waits: the infraction comes with the tail.
        to_line = stop.station - nose
        if to_line < -1.0:
            continue
        signal = situation.lights[stop.light]
        if signal is Signal.GREEN:
            return None
        needed = situation.vehicle.speed**2 / (2 * max(to_line, 0.05))
        is_late = needed > config.late_braking and stop.light != stopping_for
        if signal is Signal.YELLOW and is_late:
            return None
        return Stop(stop.light, to_line - config.stop_gap)
    return None
