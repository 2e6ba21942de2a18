"""A slip-angle tyre out of MuJoCo's own contact friction.

Inside the friction cone an elliptic contact row is viscous: force = (B / R_f) slip speed, where B is the damping of the
pair's solreffriction, R_f = R_n / impratio and R_n = (1 - d) / d * A with the impedance d of solimp and the inverse
weight A of the wheel. A tyre in its linear range is force = C slip speed / speed. So R_f = B speed / C makes MuJoCo's
contact a tyre with cornering stiffness C, saturated by the friction circle, that sticks as the speed goes to zero.

R_n stays far above A: then the normal row is the tyre's spring, and sliding does not make the contact hover.
"""

import functools
from collections.abc import Callable

import casadi as ca
import mujoco
import numpy as np
from jaxtyping import Float

from mjdrive.vehicle.assembly import WHEELS
from mjdrive.vehicle.bound import bind
from mjdrive.vehicle.parameters import VehicleParameters

MIN_SPEED = 1e-3  # of the tyre law [m/s]; below it the tyre sticks
MAX_SPEED = 80.0  # of the tyre law [m/s]; beyond it the impedance would leave MuJoCo's range
STEP_DAMPING = 0.9  # timestep * B; the explicit friction row is stable below 1
IMPEDANCE_RATIO = 300.0
MIN_NORMAL_REGULARIZATION = 0.2  # R_n [1/kg]; the impedance ratio rises near standstill to keep it
OTHER_REGULARIZATION = 1.0  # R_n against kerbs, walls and poles [1/kg]
OTHER_DAMPING = 100.0  # against the same [N s/m]


class Tyres:
    """Writes the tyre law into the four tyre-road pairs of a model.

    Attributes:
        speeds: Larger of travel and rolling speed of each tyre, in the order of `WHEELS`, shape (4,) [m/s]; to be
            written before `schedule`.
    """

    def __init__(self, model: mujoco.MjModel, parameters: VehicleParameters) -> None:
        wheels = [model.body(f"wheel_{wheel}").id for wheel in WHEELS]
        self.speeds = np.zeros(len(WHEELS))
        self._model = model
        self._option = model.opt
        self._inverse_weight = model.body_invweight0[wheels, 0].tolist()
        self._spring = parameters.tyre_vertical_stiffness
        self._damping = parameters.tyre_vertical_damping
        cornering_stiffness = np.repeat(
            [parameters.cornering_stiffness_front, parameters.cornering_stiffness_rear], 2
        )
        self._ratio = np.zeros(1)
        self._write = self._law(STEP_DAMPING / model.opt.timestep, cornering_stiffness)
        self._soften_other_contacts([model.geom(f"tyre_{wheel}").id for wheel in WHEELS])

    def schedule(self) -> None:
        """Set the friction impedance for the speed of each tyre."""
        self._write()
        self._option.impratio = self._ratio.item()

    def _law(
        self, slip_damping: float, cornering_stiffness: Float[np.ndarray, " 4"]
    ) -> Callable[[], None]:
        """What turns `speeds` into rows of the pairs and `_ratio`."""
        model = self._model
        first, *_, last = pairs = [model.pair(f"tyre_{wheel}").id for wheel in WHEELS]
        assert pairs == list(range(first, last + 1)), "the pairs of the tyres follow each other"
        rows = slice(first, last + 1)
        speeds = ca.SX.sym("speed", len(WHEELS))
        per_speed = (slip_damping / cornering_stiffness).tolist()
        friction = [
            ca.fmin(ca.fmax(speed, MIN_SPEED), MAX_SPEED) * factor
            for speed, factor in zip(ca.vertsplit(speeds), per_speed, strict=True)
        ]
        least = functools.reduce(ca.fmin, friction)
        ratio = ca.fmax(IMPEDANCE_RATIO, MIN_NORMAL_REGULARIZATION / least)
        solimp, solref, solref_friction = [], [], []
        for softness, weight, row in zip(
            friction, self._inverse_weight, model.pair_solimp[rows].tolist(), strict=True
        ):
            regularization = ratio * softness
            impedance = weight / (weight + regularization)
            scale = regularization * impedance
            solimp += [impedance, impedance, *row[2:]]
            solref += [-self._spring * scale, -self._damping * scale]
            solref_friction += [-1.0, -slip_damping * impedance]
        return bind(
            [(speeds, self.speeds)],
            [
                (ca.vertcat(*solimp), model.pair_solimp[rows]),
                (ca.vertcat(*solref), model.pair_solref[rows]),
                (ca.vertcat(*solref_friction), model.pair_solreffriction[rows]),
                (ratio, self._ratio),
            ],
        )

    def _soften_other_contacts(self, geoms: list[int]) -> None:
        """Give a tyre the same spring against kerbs and walls; a rigid one would kick three times as hard."""
        weight = np.array(self._inverse_weight)
        impedance = weight / (weight + OTHER_REGULARIZATION)
        scale = OTHER_REGULARIZATION * impedance
        self._model.geom_solimp[geoms, 0] = impedance
        self._model.geom_solimp[geoms, 1] = impedance
        self._model.geom_solref[geoms, 0] = -self._spring * scale
        self._model.geom_solref[geoms, 1] = -OTHER_DAMPING * scale
