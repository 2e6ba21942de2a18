"""Single-track reference models of a car: kinematic, and linear with two degrees of freedom.

The linear model has the states lateral speed v and yaw rate r of the centre of gravity at constant forward speed u,

    m (dv/dt + u r) = F_f + F_r              F_f = C_f (delta - (v + a r) / u)
    J dr/dt         = a F_f - b F_r          F_r = C_r (-(v - b r) / u)

with the centre of gravity a behind the front and b ahead of the rear axle, L = a + b, and all angles small.

Reference:
    Riekert, Schunck, Zur Fahrmechanik des gummibereiften Kraftfahrzeugs, Ing.-Arch. 11, 1940: the model.
    Rajamani, Vehicle Dynamics and Control, 2nd edition, 2012: section 2.2 (kinematic), equation (2.31) (linear, with our
        C_f and C_r as its 2 C_af and 2 C_ar), section 3.3 (steady state).
    Mitschke, Wallentowitz, Dynamik der Kraftfahrzeuge, 5th edition, 2014, chapter on the linear single-track model:
        characteristic speed, natural frequency, damping.
    ISO 8855:2011: understeer gradient, characteristic speed and their signs.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from jaxtyping import Float

from mjdrive.vehicle.parameters import VehicleParameters


@dataclass(frozen=True, slots=True)
class SingleTrack:
    """A car as one track: two axles, a mass and a yaw inertia.

    Attributes:
        mass: Whole car [kg].
        yaw_inertia: About the vertical through the centre of gravity [kg m2].
        front: Distance of the front axle ahead of the centre of gravity [m].
        rear: Distance of the rear axle behind it [m].
        stiffness_front: Lateral force per slip angle of the front axle, both tyres [N/rad].
        stiffness_rear: The same of the rear axle [N/rad].
    """

    mass: float
    yaw_inertia: float
    front: float
    rear: float
    stiffness_front: float
    stiffness_rear: float

    @staticmethod
    def of(model: mujoco.MjModel) -> "SingleTrack":
        """Take the car of a compiled scene, all joints in their middle.

        Args:
            model: Scene with a car that has not been driven.
        """
        parameters = VehicleParameters.of(model)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        inertia = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, inertia)
        rear = parameters.centre_of_gravity_ahead
        # The sixth velocity is the yaw rate about the rear axle; Steiner brings it to the centre of gravity.
        about_rear_axle = float(inertia[5, 5])
        return SingleTrack(
            mass=parameters.mass,
            yaw_inertia=about_rear_axle - parameters.mass * rear**2,
            front=parameters.wheelbase - rear,
            rear=rear,
            stiffness_front=2 * parameters.cornering_stiffness_front,
            stiffness_rear=2 * parameters.cornering_stiffness_rear,
        )

    @property
    def wheelbase(self) -> float:
        """Distance between the axles [m]."""
        return self.front + self.rear

    @property
    def understeer_gradient(self) -> float:
        """Steering angle beyond Ackermann's per lateral acceleration, K = m / L (b / C_f - a / C_r) [rad/(m/s2)]."""
        return (self.mass / self.wheelbase) * (
            self.rear / self.stiffness_front - self.front / self.stiffness_rear
        )

    @property
    def characteristic_speed(self) -> float:
        """Speed of the largest yaw-rate gain, sqrt(L / K); infinite unless the car understeers [m/s]."""
        gradient = self.understeer_gradient
        return math.sqrt(self.wheelbase / gradient) if gradient > 0 else math.inf

    def yaw_rate_gain(self, speed: float) -> float:
        """Steady yaw rate per steering angle, u / (L + K u^2).

        Args:
            speed: Forward speed [m/s].

        Returns:
            Gain [1/s].
        """
        return speed / (self.wheelbase + self.understeer_gradient * speed**2)

    def body_slip_gain(self, speed: float) -> float:
        """Steady body slip per steering angle.

        Args:
            speed: Forward speed [m/s].

        Returns:
            Gain [-]: b / L at walking speed, negative above the speed at which the tail swings out.
        """
        load = self.mass * self.front * speed**2 / (self.wheelbase * self.stiffness_rear)
        return (self.rear - load) / (self.wheelbase + self.understeer_gradient * speed**2)

    def matrices(self, speed: float) -> tuple[Float[np.ndarray, "2 2"], Float[np.ndarray, " 2"]]:
        """State-space form, d/dt (lateral speed, yaw rate) = A (lateral speed, yaw rate) + B steering angle.

        Args:
            speed: Forward speed, over 0 [m/s].

        Returns:
            A and B.
        """
        m, J, a, b = self.mass, self.yaw_inertia, self.front, self.rear
        C_f, C_r = self.stiffness_front, self.stiffness_rear
        turning = b * C_r - a * C_f
        # Rajamani (2.31), rows of lateral speed and yaw rate.
        A = np.array(
            [
                [-(C_f + C_r) / (m * speed), turning / (m * speed) - speed],
                [turning / (J * speed), -(a**2 * C_f + b**2 * C_r) / (J * speed)],
            ]
        )
        return A, np.array([C_f / m, a * C_f / J])

    def natural_frequency(self, speed: float) -> float:
        """Undamped natural frequency of the yaw motion [rad/s] at a forward speed [m/s]."""
        A, _ = self.matrices(speed)
        return math.sqrt(float(np.linalg.det(A)))

    def damping_ratio(self, speed: float) -> float:
        """Damping of the yaw motion over critical damping [-] at a forward speed [m/s]."""
        A, _ = self.matrices(speed)
        return -0.5 * float(np.trace(A)) / self.natural_frequency(speed)

    def respond(
        self,
        speed: float,
        time: Float[np.ndarray, " T"],
        steering_angle: Float[np.ndarray, " T"],
        *,
        start: Float[np.ndarray, " 2"] | None = None,
    ) -> tuple[Float[np.ndarray, " T"], Float[np.ndarray, " T"]]:
        """Integrate the linear model by the classical Runge-Kutta method.

        Args:
            speed: Forward speed, constant and over 0 [m/s].
            time: When the steering angle is known, increasing [s].
            steering_angle: Then; in between it is linear [rad].
            start: Lateral speed [m/s] and yaw rate [rad/s] at the first time; straight driving if None.

        Returns:
            Lateral speed of the centre of gravity [m/s] and yaw rate [rad/s] at those times.
        """
        A, B = self.matrices(speed)
        states = np.zeros((len(time), 2))
        states[0] = 0.0 if start is None else start
        for index, step in enumerate(np.diff(time)):
            state, first, last = states[index], steering_angle[index], steering_angle[index + 1]
            middle = 0.5 * (first + last)
            k1 = A @ state + B * first
            k2 = A @ (state + 0.5 * step * k1) + B * middle
            k3 = A @ (state + 0.5 * step * k2) + B * middle
            k4 = A @ (state + step * k3) + B * last
            states[index + 1] = state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        return states[:, 0], states[:, 1]


def kinematic_yaw_rate(speed: float, steering_angle: float, *, wheelbase: float) -> float:
    """Yaw rate of a car whose tyres do not slip, u tan(delta) / L (Rajamani, section 2.2, at the rear axle).

    Args:
        speed: Forward speed of the rear axle [m/s].
        steering_angle: Of the front wheels [rad].
        wheelbase: Distance between the axles [m].

    Returns:
        Yaw rate [rad/s].
    """
    return speed * math.tan(steering_angle) / wheelbase
