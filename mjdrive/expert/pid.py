"""The PID expert: follows a dense route, slows for turns and obeys the lights.

Reference:
    Chen et al., Learning by Cheating, CoRL 2019; the roaming agent of the paper's code (docs/decisions.md).
"""

from collections import deque

import numpy as np

from mjdrive import geometry
from mjdrive.config import PidConfig
from mjdrive.datatypes import Action, Route, Situation, Town
from mjdrive.expert import reference
from mjdrive.vehicle.drivetrain import Drivetrain
from mjdrive.vehicle.parameters import VehicleParameters


class Pid:
    """A PID controller whose integral sees a window of past errors.

    Args:
        gains: P, I and D.
        window: Number of errors that the integral keeps.
        interval: Time between two errors [s].
    """

    def __init__(self, gains: tuple[float, float, float], *, window: int, interval: float) -> None:
        self._gains = gains
        self._interval = interval
        self._errors: deque[float] = deque(maxlen=window)

    def step(self, error: float) -> float:
        """Take the next error and return the control value."""
        self._errors.append(error)
        proportional, integral, derivative = self._gains
        slope = (error - self._errors[-2]) / self._interval if len(self._errors) > 1 else 0.0
        total = sum(self._errors) * self._interval
        return proportional * error + integral * total + derivative * slope


class PidExpert:
    """A `Policy[Situation]`: knows the route and the lights.

    Args:
        town: Where it drives.
        parameters: Size and engine of the car.
        config: Speeds and gains.
        control_interval: Time between two decisions [s].
    """

    name = "pid"

    def __init__(
        self,
        town: Town,
        *,
        parameters: VehicleParameters | None = None,
        config: PidConfig | None = None,
        control_interval: float = 0.1,
    ) -> None:
        self.config = config or PidConfig()
        self._town = town
        parameters = parameters or VehicleParameters.default()
        self._nose_ahead = parameters.length - parameters.rear_overhang
        self._drivetrain = Drivetrain.of(parameters)
        self._interval = control_interval
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Forget past errors; the expert is deterministic, so the seed has no effect."""
        del seed
        window = self.config.integral_window
        self._speed_pid = Pid(self.config.speed_gains, window=window, interval=self._interval)
        self._steering_pid = Pid(self.config.steering_gains, window=window, interval=self._interval)
        self._route: Route | None = None
        self._stops: tuple[reference.StopLine, ...] = ()
        self._stopping_for = ""

    def act(self, view: Situation) -> Action:
        """Follow the route for the next control interval."""
        if view.route is not self._route:
            self._route = view.route
            self._stops = reference.stop_lines(self._town, view.route)
        steering = self._steer(view)
        stop = reference.stop_ahead(
            view,
            self._stops,
            nose_ahead=self._nose_ahead,
            config=self.config,
            stopping_for=self._stopping_for,
        )
        self._stopping_for = "" if stop is None else stop.light
        wanted = reference.turn_speed_limit(view, self.config)
        if abs(view.offset) > self.config.recovery_offset:
            # At speed the rack is too slow for large corrections: they would grow from side to side.
            wanted = min(wanted, self.config.recovery_speed)
        if stop is not None:
            wanted = min(wanted, float(np.sqrt(2 * self.config.braking * max(stop.distance, 0.0))))
            if wanted < 0.5 and view.vehicle.speed < 1.0:
                return Action(acceleration=-1.0, steering=0.0)
        return Action(acceleration=self._accelerate(view, wanted, steering), steering=steering)

    def _steer(self, view: Situation) -> float:
        is_turn_ahead = self._curvature_ahead(view) > 1 / self.config.turn_radius
        distance = (
            self.config.turn_target_distance if is_turn_ahead else self.config.target_distance
        )
        target = reference.point_ahead(view.route, view.station + distance)
        bearing = np.arctan2(target[1] - view.vehicle.y, target[0] - view.vehicle.x)
        error = geometry.wrap_angle(float(bearing) - view.vehicle.yaw)
        return float(np.clip(self._steering_pid.step(error), -1.0, 1.0))

    def _curvature_ahead(self, view: Situation) -> float:
        station = view.station + self.config.turn_target_distance
        return abs(float(np.interp(station, view.route.station, view.route.curvature)))

    def _accelerate(self, view: Situation, wanted: float, steering: float) -> float:
        error = wanted - view.vehicle.speed
        throttle = self._speed_pid.step(error)
        if error < 0:
            brake = self.config.brake_gain * -error
            return float(-min(brake, 1.0)) if brake > 0.1 else 0.0
        cut = max(1.0 - abs(steering), self.config.throttle_cut)
        # Over the dead band: a car that was stopped in a turn would else stand there for good, its throttle cut below it.
        return self._drivetrain.throttle(float(np.clip(throttle, 0.0, 1.0)) * cut)
