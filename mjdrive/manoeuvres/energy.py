"""The mechanical energy of a scene, with what its tyres store."""

import math

import mujoco
import numpy as np

from mjdrive.vehicle.assembly import ROAD
from mjdrive.vehicle.car import Car


class EnergyMeter:
    """Adds up kinetic energy, height, springs and tyres on the road; what kerbs and obstacles store is left out.

    Args:
        model: Scene with a car; MuJoCo is told to compute energies from the next step on, which changes no motion.
        data: Its state.
        car: The car.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, car: Car) -> None:
        model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        self._data = data
        self._on_road = [*car.tyre_geoms, model.geom(ROAD).id]
        self._stiffness = car.parameters.tyre_vertical_stiffness

    def read(self) -> float:
        """Energy at the beginning of the last physics step [J]."""
        contact = self._data.contact
        of_tyre_on_road = np.isin(contact.geom, self._on_road).all(axis=1)
        squeezed = np.minimum(contact.dist[of_tyre_on_road], 0.0)
        return float(self._data.energy.sum() + 0.5 * self._stiffness * (squeezed**2).sum())

    @property
    def is_complete(self) -> bool:
        """Whether at that time the car touched nothing but the road, and that with its tyres."""
        return bool(np.isin(self._data.contact.geom, self._on_road).all())


class GainWatch:
    """Finds energy out of nowhere, also where it is less than what an impact before has taken.

    An obstacle that is touched may give back what it stores, but no more than the car had before.

    Attributes:
        largest: Rise of the energy above the least complete one before it [J].
    """

    def __init__(self) -> None:
        self.largest = 0.0
        self._least = math.inf

    def note(self, energy: float, *, is_complete: bool) -> None:
        """Take the next reading.

        Args:
            energy: What the meter reads [J].
            is_complete: Whether nothing else could store any.
        """
        self.largest = max(self.largest, energy - self._least)
        if is_complete:
            self._least = min(self._least, energy)
