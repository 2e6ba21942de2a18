"""A slip-angle tyre out of MuJoCo's own contact friction.

Inside the friction cone an elliptic contact row is viscous: force = (B / R_f) slip speed, where B is the damping of the
pair's solreffriction, R_f = R_n / impratio and R_n = (1 - d) / d * A with the impedance d of solimp and the inverse
weight A of the wheel. A tyre in its linear range is force = C slip speed / speed. So R_f = B speed / C makes MuJoCo's
contact a tyre with cornering stiffness C, saturated by the friction circle, that sticks as the speed goes to zero.

R_n stays far above A: then the normal row is the tyre's spring, and sliding does not make the contact hover.
"""

from typing import NamedTuple

import mujoco
import numpy as np

from mjdrive.vehicle.assembly import WHEELS
from mjdrive.vehicle.parameters import VehicleParameters

MIN_SPEED = 1e-3  # of the tyre law [m/s]; below it the tyre sticks
MAX_SPEED = 80.0  # of the tyre law [m/s]; beyond it the impedance would leave MuJoCo's range
STEP_DAMPING = 0.9  # timestep * B; the explicit friction row is stable below 1
IMPEDANCE_RATIO = 300.0
MIN_NORMAL_REGULARIZATION = 0.2  # R_n [1/kg]; the impedance ratio rises near standstill to keep it
OTHER_REGULARIZATION = 1.0  # R_n against kerbs, walls and poles [1/kg]
OTHER_DAMPING = 100.0  # against the same [N s/m]


class _Row(NamedTuple):
    """The pair of one tyre with the road.

    Attributes:
        weight: Inverse weight of the wheel [1/kg].
        solimp: Memory of the model.
        solref: Memory of the model.
        solref_friction: Memory of the model.
    """

    weight: float
    solimp: "memoryview[float]"
    solref: "memoryview[float]"
    solref_friction: "memoryview[float]"


class Tyres:
    """Writes the tyre law into the four tyre-road pairs of a model."""

    def __init__(self, model: mujoco.MjModel, parameters: VehicleParameters) -> None:
        wheels = [model.body(f"wheel_{wheel}").id for wheel in WHEELS]
        self._model = model
        self._option = model.opt
        first, *_, last = pairs = [model.pair(f"tyre_{wheel}").id for wheel in WHEELS]
        assert pairs == list(range(first, last + 1)), "the pairs of the tyres follow each other"
        self._inverse_weight = model.body_invweight0[wheels, 0].tolist()
        # Memory of the model, written row by row: four rows are done before numpy has begun.
        self._rows = [
            _Row(
                weight=weight,
                solimp=memoryview(model.pair_solimp[pair]),
                solref=memoryview(model.pair_solref[pair]),
                solref_friction=memoryview(model.pair_solreffriction[pair]),
            )
            for pair, weight in zip(pairs, self._inverse_weight, strict=True)
        ]
        model.pair_solreffriction[first : last + 1, 0] = -1.0
        self._spring = parameters.tyre_vertical_stiffness
        self._damping = parameters.tyre_vertical_damping
        self._slip_damping = STEP_DAMPING / model.opt.timestep
        cornering_stiffness = np.repeat(
            [parameters.cornering_stiffness_front, parameters.cornering_stiffness_rear], 2
        )
        self._per_speed = (self._slip_damping / cornering_stiffness).tolist()
        self._soften_other_contacts([model.geom(f"tyre_{wheel}").id for wheel in WHEELS])

    def schedule(self, speeds: list[float]) -> None:
        """Set the friction impedance for the speed of each tyre.

        Args:
            speeds: Larger of travel and rolling speed, in the order of `WHEELS` [m/s].
        """
        friction = [
            min(max(speed, MIN_SPEED), MAX_SPEED) * per_speed
            for speed, per_speed in zip(speeds, self._per_speed, strict=True)
        ]
        ratio = max(IMPEDANCE_RATIO, MIN_NORMAL_REGULARIZATION / min(friction))
        self._option.impratio = ratio
        spring, damping, slip_damping = -self._spring, -self._damping, -self._slip_damping
        for (weight, solimp, solref, solref_friction), softness in zip(
            self._rows, friction, strict=True
        ):
            regularization = ratio * softness
            impedance = weight / (weight + regularization)
            scale = regularization * impedance
            solimp[0] = solimp[1] = impedance
            solref[0] = spring * scale
            solref[1] = damping * scale
            solref_friction[1] = slip_damping * impedance

    def _soften_other_contacts(self, geoms: list[int]) -> None:
        """Give a tyre the same spring against kerbs and walls; a rigid one would kick three times as hard."""
        weight = np.array(self._inverse_weight)
        impedance = weight / (weight + OTHER_REGULARIZATION)
        scale = OTHER_REGULARIZATION * impedance
        self._model.geom_solimp[geoms, 0] = impedance
        self._model.geom_solimp[geoms, 1] = impedance
        self._model.geom_solref[geoms, 0] = -self._spring * scale
        self._model.geom_solref[geoms, 1] = -OTHER_DAMPING * scale
