"""Tells whether a car is on a lane that runs its way."""

import math

from mjdrive.datatypes import Town, VehicleState
from mjdrive.town.foothold import LEAST_COSINE, Foothold
from mjdrive.town.lane_index import LaneIndex
from mjdrive.vehicle.parameters import VehicleParameters


class LaneSense:
    """Looks at the lanes under the centre of a car.

    Args:
        town: Where it drives.
        parameters: Size of the car.
    """

    def __init__(self, town: Town, parameters: VehicleParameters) -> None:
        self._index = LaneIndex(town)
        self._foothold = Foothold(self._index)
        self._centre_ahead = parameters.length / 2 - parameters.rear_overhang

    def follows(self, vehicle: VehicleState) -> bool:
        """Whether some lane under the centre of the car runs within 60 degrees of its heading."""
        x = vehicle.x + self._centre_ahead * math.cos(vehicle.yaw)
        y = vehicle.y + self._centre_ahead * math.sin(vehicle.yaw)
        if self._foothold.holds(x, y, vehicle.yaw):
            return True
        for place in self._index.under(x, y):
            if math.cos(vehicle.yaw - place.yaw) >= LEAST_COSINE:
                self._foothold.set_on(place)
                return True
        return False
