"""Full throttle from rest to 100 km/h."""

import numpy as np

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.recording import Recording
from mjdrive.manoeuvres.rig import Rig

TARGET = 100 / 3.6  # [m/s]
LEAST, MOST = 7.5, 9.5  # time of a family saloon [s]
PATIENCE = 40.0  # [s]


def accelerate(rig: Rig) -> Recording:
    """Drive from rest with full throttle until the car is faster than 100 km/h.

    Args:
        rig: On a flat road.

    Returns:
        The recording, from the moment in which the pedal is pressed.
    """
    rig.place()
    return rig.drive(
        lambda _: Action(acceleration=1.0, steering=0.0),
        duration=PATIENCE,
        until=lambda moment: moment.speed > TARGET,
    )


def time_to_target(recording: Recording) -> float:
    """Time to 100 km/h [s]; not a number if the car never got there."""
    if recording.speed[-1] < TARGET:
        return float("nan")
    return float(np.interp(TARGET, recording.speed, recording.time))


def bars(recording: Recording) -> tuple[Bar, ...]:
    """Hold the time against that of a family saloon."""
    seconds = time_to_target(recording)
    return (Bar("acceleration", "0 to 100 km/h", seconds, "s", LEAST, MOST, "of a family saloon"),)
