"""Spares MuJoCo the search for contacts with a town while nothing stands near the car.

The search through hundreds of kerbs and houses takes as long as half a step of the car itself. It is left out only where
it would find nothing, so the car moves the same bit by bit.
"""

import math
from collections.abc import Sequence

import mujoco
import numpy as np

WORLD = 0  # number of the body that holds all that stands
MARGIN = 0.3  # steered wheels stand out of the box around the car [m]
REACH_TIME = 0.1  # for which the answer holds, at the speed of the car [s]
LEAST_UPRIGHT = 0.9  # a car that leans more may touch the road with its roof [-]
ROAM = 15.0  # way for which the boxes around the car are looked up at once [m]
_NOTHING = (0, 0)


class Surroundings:
    """Switches contacts between the car and the world body off and on; those of the tyres with the road are apart.

    Args:
        model: Scene of `car_on_road`. If anything but the car can move in it, contacts stay on.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        rotation = data.geom_xmat.reshape(-1, 3, 3)
        centre = data.geom_xpos + np.einsum("nij,nj->ni", rotation, model.geom_aabb[:, :3])
        half = np.einsum("nij,nj->ni", np.abs(rotation), model.geom_aabb[:, 3:])
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        stands = collides & (model.geom_bodyid == WORLD)
        stands &= model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE
        of_car = collides & (model.body_rootid[model.geom_bodyid] == model.body("car").id)
        self._left, self._bottom = (centre - half)[stands, :2].T.copy()
        self._right, self._top = (centre + half)[stands, :2].T.copy()
        rear, front = (centre - half)[of_car, 0].min(), (centre + half)[of_car, 0].max()
        self._middle, self._half_length = 0.5 * float(front + rear), 0.5 * float(front - rear)
        self._half_width = float((np.abs(centre[:, 1]) + half[:, 1])[of_car].max())
        self._bits = int(model.body_contype[WORLD]), int(model.body_conaffinity[WORLD])
        self._contype = memoryview(model.body_contype)
        self._conaffinity = memoryview(model.body_conaffinity)
        self._is_alone = model.ntree == 1
        self._around: list[tuple[float, float, float, float]] = []
        self._known = (
            math.nan,
            math.nan,
            math.nan,
        )  # middle and half side of where `_around` holds [m]

    def update(self, qpos: Sequence[float], *, speed: float) -> None:
        """Search for contacts with the world from now on only if something stands near.

        Args:
            qpos: Positions of the scene, those of the car first.
            speed: Of the car in the plane [m/s].
        """
        bits = self._bits if not self._is_alone or self._is_near(qpos, speed) else _NOTHING
        self._contype[WORLD], self._conaffinity[WORLD] = bits

    def _is_near(self, qpos: Sequence[float], speed: float) -> bool:
        """Whether the car, or where it may be soon, meets the box around anything that stands."""
        x, y, _, w, i, j, k, *_ = qpos
        if 1.0 - 2.0 * (i * i + j * j) < LEAST_UPRIGHT:
            return True
        cosine, sine = 1.0 - 2.0 * (j * j + k * k), 2.0 * (i * j + w * k)
        x, y = x + self._middle * cosine, y + self._middle * sine
        reach = MARGIN + REACH_TIME * speed
        along_x = abs(cosine) * self._half_length + abs(sine) * self._half_width + reach
        along_y = abs(sine) * self._half_length + abs(cosine) * self._half_width + reach
        known_x, known_y, known = self._known
        if not (abs(x - known_x) + along_x <= known and abs(y - known_y) + along_y <= known):
            self._look_around(x, y, max(along_x, along_y) + ROAM)
        left, right, bottom, top = x - along_x, x + along_x, y - along_y, y + along_y
        for box_left, box_right, box_bottom, box_top in self._around:  # `any` is slower by half
            if box_left < right and box_right > left and box_bottom < top and box_top > bottom:
                return True
        return False

    def _look_around(self, x: float, y: float, reach: float) -> None:
        """List the boxes that meet a square, so that few have to be compared while the car is within it."""
        meet = (self._left < x + reach) & (self._right > x - reach)
        meet &= (self._bottom < y + reach) & (self._top > y - reach)
        sides = (self._left, self._right, self._bottom, self._top)
        self._around = list(zip(*(side[meet].tolist() for side in sides), strict=True))
        self._known = x, y, reach
