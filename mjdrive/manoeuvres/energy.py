"""The mechanical energy of a scene, with what its tyres store."""

import math

import mujoco
import numpy as np

from mjdrive.vehicle.assembly import ROAD
from mjdrive.vehicle.car import Car

_PER_SPEED = 2
"""Where an affine gain or bias keeps its change with speed."""


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


class WorkMeter:
    """Adds up what the actuators do to a scene, to be held against what an `EnergyMeter` reads.

    MuJoCo tells the force of an actuator at the beginning of a step, but takes the part of it that depends on speed at the
    end (`implicitfast`), unless the force is at its limit; without that the work of a rack that starts or stops is off by
    a third.

    Args:
        model: Scene, whose actuators have gains and biases that are fixed or affine.
        data: Its state; all of its actuators have activations.

    Attributes:
        total: Work from the first step that was noted up to the beginning of the last one [J].
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.total = 0.0
        self._data = data
        self._timestep = float(model.opt.timestep)
        self._activations = model.actuator_actadr.tolist()
        affine = model.actuator_gaintype == mujoco.mjtGain.mjGAIN_AFFINE
        self._slopes_per_activation = (affine * model.actuator_gainprm[:, _PER_SPEED]).tolist()
        affine = model.actuator_biastype == mujoco.mjtBias.mjBIAS_AFFINE
        self._slopes = (affine * model.actuator_biasprm[:, _PER_SPEED]).tolist()
        unlimited = model.actuator_forcelimited == 0
        self._limits = np.where(unlimited[:, None], [-np.inf, np.inf], model.actuator_forcerange)
        self._limits = self._limits.tolist()
        self._act = data.act.tolist()
        self._last: list[tuple[float, float, float]] = []

    def note(self) -> None:
        """Take the physics step that was just done; to be called after each."""
        data = self._data
        speeds = data.actuator_velocity.tolist()
        for (force, slope, before), now in zip(self._last, speeds, strict=False):
            mean_speed = 0.5 * (before + now)
            self.total += (force + slope * (now - before)) * mean_speed * self._timestep
        forces = data.actuator_force.tolist()
        self._last = [
            (force, self._slope(number, force), speed)
            for number, (force, speed) in enumerate(zip(forces, speeds, strict=True))
        ]
        self._act = data.act.tolist()  # what the forces of the next step come from

    def _slope(self, number: int, force: float) -> float:
        """Change of an actuator's force with its speed, as MuJoCo takes it."""
        least, most = self._limits[number]
        if not least < force < most:
            return 0.0
        activation = self._act[self._activations[number]]
        return self._slopes[number] + self._slopes_per_activation[number] * activation


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
