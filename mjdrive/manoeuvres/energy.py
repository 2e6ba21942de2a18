"""The mechanical energy of a scene, with what its tyres store."""

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
