"""The single-track model of the car along a line: one definition for numbers, numpy arrays and casadi symbols.

Steady-state slip angles, no yaw inertia: below 4 m/s2 and at town speeds the car reaches them within a control interval.
The maths comes in as `Trigonometry`, so that this file knows neither numpy nor casadi.

Reference:
    Rajamani, Vehicle Dynamics and Control, 2nd edition, 2012, sections 2.2 and 3.3; Werling et al., Optimal Trajectory
    Generation for Dynamic Street Scenarios in a Frenet Frame, ICRA 2010.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from mjdrive.vehicle.parameters import VehicleParameters


class Trigonometry(NamedTuple):
    """Sine, cosine and tangent of whatever the model is computed with."""

    sin: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    tan: Callable[[Any], Any]


class BicycleState(NamedTuple):
    """Where the rear axle is along a line, and how it moves; numbers, arrays or symbols.

    Attributes:
        station: Arc length along the line [m].
        offset: Distance from the line, positive to the left [m].
        heading_error: Yaw of the car against the line [rad].
        speed: Forward speed of the rear axle [m/s].
        acceleration: Rate of the speed [m/s2].
        steering_angle: Centre steering angle of the front wheels [rad].
        steering_rate: Rate of that angle [rad/s].
    """

    station: Any
    offset: Any
    heading_error: Any
    speed: Any
    acceleration: Any
    steering_angle: Any
    steering_rate: Any


class BicycleInput(NamedTuple):
    """What drives the model; numbers, arrays or symbols.

    Attributes:
        jerk: Rate of the acceleration [m/s3].
        steering_jolt: Rate of the steering rate [rad/s2].
    """

    jerk: Any
    steering_jolt: Any


class Bicycle(NamedTuple):
    """The numbers of a car as a single-track model.

    Attributes:
        wheelbase: Distance between the axles [m].
        understeer: Steering angle that lateral acceleration asks for beyond the kinematic one [rad s2/m].
        rear_compliance: Slip angle of the rear axle per lateral acceleration [rad s2/m].
    """

    wheelbase: float
    understeer: float
    rear_compliance: float

    @staticmethod
    def of(car: VehicleParameters) -> "Bicycle":
        """Lump the two wheels of each axle together."""
        ahead, behind = car.wheelbase - car.centre_of_gravity_ahead, car.centre_of_gravity_ahead
        load = car.mass / car.wheelbase
        front = load * behind / (2 * car.cornering_stiffness_front)
        rear = load * ahead / (2 * car.cornering_stiffness_rear)
        return Bicycle(car.wheelbase, front - rear, rear)  # Rajamani (3.12)

    def path_curvature(self, steering_angle: Any, speed: Any, maths: Trigonometry) -> Any:
        """Curvature of the steady circle at a steering angle [rad] and a speed [m/s]; positive to the left [1/m]."""
        return maths.tan(steering_angle) / (self.wheelbase + self.understeer * speed * speed)

    def derivative(
        self, state: BicycleState, drive: BicycleInput, *, curvature: Any, maths: Trigonometry
    ) -> BicycleState:
        """Time derivative of the state.

        Args:
            state: Where the car is along the line.
            drive: Jerk and steering jolt.
            curvature: Of the line at the car, positive to the left [1/m].
            maths: What sine and cosine are here.

        Returns:
            Rate of each number of the state, in its unit per second.
        """
        speed = state.speed
        turn = self.path_curvature(state.steering_angle, speed, maths)
        slip = -self.rear_compliance * speed * speed * turn
        course = state.heading_error + slip
        progress = speed * maths.cos(course) / (1.0 - state.offset * curvature)
        return BicycleState(
            station=progress,
            offset=speed * maths.sin(course),
            heading_error=speed * turn - curvature * progress,
            speed=state.acceleration,
            acceleration=drive.jerk,
            steering_angle=state.steering_rate,
            steering_rate=drive.steering_jolt,
        )

    def step(
        self,
        state: BicycleState,
        drive: BicycleInput,
        *,
        interval: float,
        curvature: Any,
        maths: Trigonometry,
    ) -> BicycleState:
        """State after an interval, by the midpoint rule: the error falls with the cube of the interval.

        Args:
            state: State at the beginning.
            drive: Held for the whole interval.
            interval: Time [s].
            curvature: Of the line during the interval, positive to the left [1/m].
            maths: What sine and cosine are here.

        Returns:
            State at the end.
        """
        rate = self.derivative(state, drive, curvature=curvature, maths=maths)
        middle = _moved(state, rate, 0.5 * interval)
        return _moved(
            state, self.derivative(middle, drive, curvature=curvature, maths=maths), interval
        )


def _moved(state: BicycleState, rate: BicycleState, time: float) -> BicycleState:
    return BicycleState(*(value + time * slope for value, slope in zip(state, rate, strict=True)))
