"""How often a free drive came up to a traffic light, so that red lights run have something to be counted against."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mjdrive.datatypes import Episode, Signal, Town, TrafficLight
from mjdrive.town import signals

REACH = 12.0
"""A light is met when the rear axle is this near before its stop line [m]: 4 m of car, 8 m of caution."""

LEAST_COSINE = 0.5
"""Smallest cosine between the heading of the car and the direction that the stop line is crossed in [-]."""


@dataclass(frozen=True, slots=True)
class LightsMet:
    """Stop lines that a drive came up to.

    Attributes:
        lights: Times that it came up to one [-].
        reds: Of these, times that the light was red at one step or more while the car was before it [-].
    """

    lights: int
    reds: int


def lights_met(episode: Episode, town: Town) -> LightsMet:
    """Count the lights that a drive came up to, each time anew, whether it went over the line or not.

    Args:
        episode: The drive.
        town: The town that it was driven in.
    """
    num_lights = num_reds = 0
    for light in town.lights.values():
        edges = np.flatnonzero(
            np.diff(is_before(episode.vehicle, light), prepend=False, append=False)
        )
        for first, last in zip(edges[::2], edges[1::2], strict=True):
            times = episode.time[first:last] + episode.light_phase
            num_lights += 1
            num_reds += any(signals.at(light, float(time)) is Signal.RED for time in times)
    return LightsMet(num_lights, num_reds)


def is_before(vehicle: Float[np.ndarray, "T 6"], light: TrafficLight) -> Bool[np.ndarray, " T"]:
    """Whether the rear axle is within reach before the stop line, in its lane and direction, step by step.

    Args:
        vehicle: Rows of `Episode.vehicle`, mixed units.
        light: Of the stop line.
    """
    forward = np.array([np.cos(light.yaw), np.sin(light.yaw)])
    left = np.array([-forward[1], forward[0]])
    relative = vehicle[:, :2] - light.stop_line.mean(axis=0)
    half_width = 0.5 * np.hypot(*(light.stop_line[0] - light.stop_line[1]))
    ahead = -relative @ forward
    return np.asarray(
        (ahead > 0)
        & (ahead < REACH)
        & (np.abs(relative @ left) < half_width)
        & (np.cos(vehicle[:, 2] - light.yaw) > LEAST_COSINE)
    )
