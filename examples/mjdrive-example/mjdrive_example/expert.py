"""An expert in a few lines: it steers towards a point of its route and stops for nothing.

Source: Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01.
"""

import math

import numpy as np

from mjdrive.datatypes import Action, Situation, Town
from mjdrive.vehicle.parameters import VehicleParameters

SPEED = 4.0
"""How fast it drives [m/s]."""

AHEAD = 5.0
"""Distance along the route to the point that it steers towards [m]."""


class PurePursuit:
    """Drives on the arc that leads to a point of the route.

    Args:
        town: Where it drives.
        parameters: Numbers of the car.
        control_interval: Time between two decisions [s].
    """

    name = "example-expert"

    def __init__(
        self, town: Town, *, parameters: VehicleParameters, control_interval: float
    ) -> None:
        self._parameters = parameters

    def reset(self, seed: int) -> None:
        """Nothing is remembered, and nothing is left to chance."""

    def act(self, view: Situation) -> Action:
        """Steer towards the route.

        Args:
            view: The truth.
        """
        car, route, station = view.vehicle, view.route, view.station + AHEAD
        x, y = (float(np.interp(station, route.station, route.points[:, axis])) for axis in (0, 1))
        bearing = math.atan2(y - car.y, x - car.x) - car.yaw
        distance = max(math.hypot(x - car.x, y - car.y), 1.0)
        angle = math.atan(self._parameters.wheelbase * 2.0 * math.sin(bearing) / distance)
        return Action(
            acceleration=min(max(0.5 * (SPEED - car.speed), -1.0), 0.5),
            steering=min(max(angle / self._parameters.max_steering_angle, -1.0), 1.0),
        )
