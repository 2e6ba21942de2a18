"""A minute at rest with the brake on: flat, and on slopes."""

from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.recording import Recording
from mjdrive.manoeuvres.rig import Rig

MOST_CREEP_MM = {0.0: 1.0, 0.1: 1.0, 0.2: 2.0}
"""By slope [-]: how far the car may creep [mm]."""

SETTLING = 4.0  # [s]
DURATION = 60.0  # [s]


class Standstill(NamedTuple):
    """A minute at rest.

    Attributes:
        slope: Rise over run of the road ahead [-].
        recording: After the car has settled.
    """

    slope: float
    recording: Recording

    @property
    def creep_mm(self) -> float:
        """How far the car is from where it stood, at most [mm]."""
        x, y = self.recording.x, self.recording.y
        return 1000.0 * float(np.hypot(x - x[0], y - y[0]).max())


def stand(rig: Rig, slope: float, duration: float = DURATION) -> Standstill:
    """Hold the brake.

    Args:
        rig: On a road of that slope.
        slope: Rise over run of the road ahead [-].
        duration: How long [s].

    Returns:
        The standstill.
    """

    def hold(_: object) -> Action:
        return Action(acceleration=-1.0, steering=0.0)

    rig.place()
    rig.drive(hold, duration=SETTLING)
    return Standstill(slope, rig.drive(hold, duration=duration))


def bars(standstill: Standstill) -> tuple[Bar, ...]:
    """Hold the creep against millimetres a minute."""
    slope = standstill.slope
    return (
        Bar(
            "standstill, 60 s",
            "creep, flat" if slope == 0 else f"creep, {100 * slope:.0f} % slope",
            standstill.creep_mm,
            "mm",
            most=MOST_CREEP_MM[slope],
        ),
    )
