"""Full lock at walking speed."""

import math
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.plant import SpeedHold
from mjdrive.manoeuvres.recording import Recording
from mjdrive.manoeuvres.rig import Rig
from mjdrive.vehicle.parameters import VehicleParameters

SPEED = 2.0  # [m/s]
SETTLING = 4.0  # until lock and speed are reached [s]
DURATION = 16.0  # over a full circle [s]
RADIUS = (3.5, 5.5)  # of the rear-axle centre [m]


class TurningCircle(NamedTuple):
    """A circle at full lock.

    Attributes:
        recording: After lock and speed have been reached.
        parameters: The car.
    """

    recording: Recording
    parameters: VehicleParameters

    @property
    def centre(self) -> tuple[float, float]:
        """Of the circle, world frame [m]."""
        x, y, _ = _fit(self.recording)
        return x, y

    @property
    def radius(self) -> float:
        """Of the path of the rear-axle centre [m]."""
        return _fit(self.recording)[2]

    @property
    def expected_radius(self) -> float:
        """Wheelbase over the tangent of the steering angle: tyres that do not slip [m]."""
        return self.parameters.wheelbase / math.tan(self.parameters.max_steering_angle)

    @property
    def kerb_to_kerb(self) -> float:
        """Diameter of the circle of the outer front wheel, the turning circle of brochures [m]."""
        outer = self.radius + 0.5 * self.parameters.track
        return 2.0 * math.hypot(outer, self.parameters.wheelbase)


def turn(rig: Rig) -> TurningCircle:
    """Drive round at full lock to the left.

    Args:
        rig: On a flat road.

    Returns:
        The circle.
    """
    hold = SpeedHold(SPEED)
    rig.place(speed=SPEED)
    rig.drive(lambda moment: Action(hold(moment), 1.0), duration=SETTLING)
    recording = rig.drive(lambda moment: Action(hold(moment), 1.0), duration=DURATION)
    return TurningCircle(recording, rig.car.parameters)


def _fit(recording: Recording) -> tuple[float, float, float]:
    """Circle through a path by linear least squares: centre and radius [m]."""
    x, y = recording.x, recording.y
    A = np.stack([2 * x, 2 * y, np.ones_like(x)], axis=1)
    (centre_x, centre_y, rest), *_ = np.linalg.lstsq(A, x**2 + y**2, rcond=None)
    return float(centre_x), float(centre_y), math.sqrt(rest + centre_x**2 + centre_y**2)


def bars(circle: TurningCircle) -> tuple[Bar, ...]:
    """Hold the radius against the streets of the towns."""
    reason = f"Ackermann {circle.expected_radius:.2f} m; kerb to kerb {circle.kerb_to_kerb:.1f} m"
    return (
        Bar("turning circle", "radius at full lock", circle.radius, "m", *RADIUS, reason=reason),
    )
