"""Spares MuJoCo the search for contacts with a town while nothing stands near the car.

The search through hundreds of kerbs and houses takes as long as half a step of the car itself. It is left out only where
it would find nothing, so the car moves the same bit by bit.
"""

import math
from collections.abc import Callable

import casadi as ca
import mujoco
import numpy as np
from jaxtyping import Float

from mjdrive.vehicle.bound import bind

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
        data: Its state, whose memory is read.

    Attributes:
        are_near: Whether contacts are on; while they are off, the car touches nothing but the road, with its tyres.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.are_near = True
        still = mujoco.MjData(model)
        mujoco.mj_kinematics(model, still)
        rotation = still.geom_xmat.reshape(-1, 3, 3)
        centre = still.geom_xpos + np.einsum("nij,nj->ni", rotation, model.geom_aabb[:, :3])
        half = np.einsum("nij,nj->ni", np.abs(rotation), model.geom_aabb[:, 3:])
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        stands = collides & (model.geom_bodyid == WORLD)
        stands &= model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE
        of_car = collides & (model.body_rootid[model.geom_bodyid] == model.body("car").id)
        self._left, self._bottom = (centre - half)[stands, :2].T.copy()
        self._right, self._top = (centre + half)[stands, :2].T.copy()
        rear, front = (centre - half)[of_car, 0].min(), (centre + half)[of_car, 0].max()
        half_width = float((np.abs(centre[:, 1]) + half[:, 1])[of_car].max())
        self._speed, self._reached = np.zeros(1), np.zeros(5)
        self._reach = self._reaching(
            data.qpos, rear=float(rear), front=float(front), half_width=half_width
        )
        self._bits = int(model.body_contype[WORLD]), int(model.body_conaffinity[WORLD])
        self._contype = memoryview(model.body_contype)
        self._conaffinity = memoryview(model.body_conaffinity)
        self._is_alone = model.ntree == 1
        self._around: list[tuple[float, float, float, float]] = []
        self._known = (math.nan,) * 4  # left, right, bottom and top of where `_around` holds [m]

    def update(self, speed: float) -> None:
        """Search for contacts with the world from now on only if something stands near.

        Args:
            speed: Of the car in the plane [m/s].
        """
        self._speed[0] = speed
        self.are_near = not self._is_alone or self._meet_the_car()
        bits = self._bits if self.are_near else _NOTHING
        self._contype[WORLD], self._conaffinity[WORLD] = bits

    def _meet_the_car(self) -> bool:
        """Whether the car, or where it may be soon, meets the box around anything that stands."""
        self._reach()
        upright, left, right, bottom, top = self._reached.tolist()
        if upright < LEAST_UPRIGHT:
            return True
        known_left, known_right, known_bottom, known_top = self._known
        if not (
            known_left <= left
            and right <= known_right
            and known_bottom <= bottom
            and top <= known_top
        ):
            self._look_around(left, right, bottom, top)
        for box_left, box_right, box_bottom, box_top in self._around:  # `any` is slower by half
            if box_left < right and box_right > left and box_bottom < top and box_top > bottom:
                return True
        return False

    def _look_around(self, left: float, right: float, bottom: float, top: float) -> None:
        """List the boxes that meet a larger rectangle, so that few have to be compared while the car is within it."""
        left, right, bottom, top = left - ROAM, right + ROAM, bottom - ROAM, top + ROAM
        meet = (self._left < right) & (self._right > left)
        meet &= (self._bottom < top) & (self._top > bottom)
        sides = (self._left, self._right, self._bottom, self._top)
        self._around = list(zip(*(side[meet].tolist() for side in sides), strict=True))
        self._known = left, right, bottom, top

    def _reaching(
        self, qpos: Float[np.ndarray, " Q"], *, rear: float, front: float, half_width: float
    ) -> Callable[[], None]:
        """What turns pose and speed into how upright the car is, and the rectangle that it may be in soon, in `_reached`.

        Args:
            qpos: Positions of the scene, those of the car first.
            rear: Rear end of the car before its rear axle [m].
            front: Front end of the car before its rear axle [m].
            half_width: Of the car [m].
        """
        pose, speed = ca.SX.sym("qpos", len(qpos)), ca.SX.sym("speed")
        x, y, _, w, i, j, k, *_ = ca.vertsplit(pose)
        cosine, sine = 1.0 - 2.0 * (j * j + k * k), 2.0 * (i * j + w * k)
        middle, half_length = 0.5 * (front + rear), 0.5 * (front - rear)
        x, y = x + middle * cosine, y + middle * sine
        reach = MARGIN + REACH_TIME * speed
        along_x = ca.fabs(cosine) * half_length + ca.fabs(sine) * half_width + reach
        along_y = ca.fabs(sine) * half_length + ca.fabs(cosine) * half_width + reach
        upright = 1.0 - 2.0 * (i * i + j * j)
        found = ca.vertcat(upright, x - along_x, x + along_x, y - along_y, y + along_y)
        return bind([(pose, qpos), (speed, self._speed)], [(found, self._reached)])
