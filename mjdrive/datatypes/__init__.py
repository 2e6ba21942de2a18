"""The nouns. SI units throughout; every array is read-only once it is inside one of these.

World frame: x east, y north, z up (OpenDRIVE axes; CARLA's y is minus ours). Vehicle frame: x forward, y left, z up
(ISO 8855), origin on the ground under the centre of the rear axle. Yaw is counter-clockwise from world +x, in (-pi, pi].
"""

from mjdrive.datatypes.driving import (
    Action,
    Episode,
    Infraction,
    InfractionKind,
    Observation,
    Policy,
    Situation,
    VehicleState,
)
from mjdrive.datatypes.town import (
    Lane,
    Marking,
    Move,
    Route,
    Sign,
    Signal,
    StaticObject,
    Town,
    TrafficLight,
)

__all__ = [
    "Action",
    "Episode",
    "Infraction",
    "InfractionKind",
    "Lane",
    "Marking",
    "Move",
    "Observation",
    "Policy",
    "Route",
    "Sign",
    "Signal",
    "Situation",
    "StaticObject",
    "Town",
    "TrafficLight",
    "VehicleState",
]
