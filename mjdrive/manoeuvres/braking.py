"""Full brake from a speed to rest, against the distance that friction and the lag of the actuator allow."""

from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.bars import Bar, around
from mjdrive.manoeuvres.recording import Recording
from mjdrive.manoeuvres.rig import GRAVITY, Rig

SPEEDS_KMH = (50, 100)
STANDS = 0.02  # speed below which the car counts as stopped [m/s]
SHARE = 0.10  # that a stop may be longer or shorter than the closed form [-]
PATIENCE = 20.0  # [s]


class Stop(NamedTuple):
    """One stop.

    Attributes:
        speed_kmh: When the pedal was pressed [km/h].
        recording: From then on.
        expected: Distance by the closed form [m].
    """

    speed_kmh: int
    recording: Recording
    expected: float

    @property
    def distance(self) -> float:
        """From pressing the pedal to rest [m]; not a number if the car never stopped."""
        if self.recording.speed[-1] > STANDS:
            return float("nan")
        return float(self.recording.distance[-1])


def brake(rig: Rig, speed_kmh: int) -> Stop:
    """Press the brake fully at a speed.

    Args:
        rig: On a flat road.
        speed_kmh: Speed to brake from [km/h].

    Returns:
        The stop.
    """
    speed = speed_kmh / 3.6
    rig.place(speed=speed)
    recording = rig.drive(
        lambda _: Action(acceleration=-1.0, steering=0.0),
        duration=PATIENCE,
        until=lambda moment: moment.speed < STANDS,
    )
    lag = rig.car.parameters.brake_lag
    return Stop(speed_kmh, recording, stopping_distance(speed, friction=rig.friction, lag=lag))


def stopping_distance(speed: float, *, friction: float, lag: float) -> float:
    """Distance of a stop at the friction limit: u^2 / (2 mu g), and u times the lag before that.

    Args:
        speed: When the pedal is pressed [m/s].
        friction: Between tyre and road [-].
        lag: Time constant of the brake [s].

    Returns:
        Distance [m].
    """
    return float(speed**2 / (2 * friction * GRAVITY) + speed * lag)


def mean_deceleration(stop: Stop) -> float:
    """Mean deceleration between 80 % and 10 % of the speed, as UN Regulation 13-H defines it [m/s2]."""
    speed, distance = stop.recording.speed, stop.recording.distance
    fast, slow = 0.8 * stop.speed_kmh / 3.6, 0.1 * stop.speed_kmh / 3.6
    at_fast, at_slow = np.interp([-fast, -slow], -speed, distance)
    return float((fast**2 - slow**2) / (2 * (at_slow - at_fast)))


def bars(stop: Stop) -> tuple[Bar, ...]:
    """Hold the distance against the closed form."""
    reason = f"v^2 / (2 mu g) + lag v = {stop.expected:.2f} m, within {100 * SHARE:.0f} %"
    return (
        Bar(
            "braking",
            f"{stop.speed_kmh} to 0 km/h",
            stop.distance,
            "m",
            **around(stop.expected, SHARE),
            reason=reason,
        ),
    )
