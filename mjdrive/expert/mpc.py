"""The MPC expert: plans two seconds ahead with a model of the car, and drives the first tenth of the plan.

Ten times a second it lays a reference along the route (`speed_profile`), takes the state of the car in Frenet
coordinates, and solves a nonlinear optimal control problem (`mpc_problem`) for steering and acceleration. A decision
without a plan is made by the PID expert, and counted.
"""

import time
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.config import MpcConfig, PidConfig
from mjdrive.datatypes import Action, Route, Situation, Town
from mjdrive.expert import reference
from mjdrive.expert.frenet import frenet_state
from mjdrive.expert.handover import Handover
from mjdrive.expert.mpc_problem import MpcProblem
from mjdrive.expert.mpc_solver import MpcSolver, SolveStatus
from mjdrive.expert.pid import PidExpert
from mjdrive.expert.pushes import PushWatch
from mjdrive.expert.solves import SolveCounts
from mjdrive.expert.speed_profile import Reference, SpeedProfile
from mjdrive.vehicle.bicycle import BicycleState
from mjdrive.vehicle.drivetrain import Drivetrain
from mjdrive.vehicle.parameters import VehicleParameters

HOLD_SPEED = 0.15
"""A car slower than this at its resting place is held by the brake [m/s]."""

HOLD_DISTANCE = 0.4
"""It has come to its resting place when that is this near [m]."""


class _Plan(NamedTuple):
    """What was decided last time, to go on from.

    Attributes:
        time: When [s].
        variables: The whole plan.
        following: State that it foresaw for the next decision.
    """

    time: float
    variables: Float[np.ndarray, " X"]
    following: BicycleState


class MpcExpert:
    """A `Policy[Situation]`: knows the route and the lights, and a model of its car.

    Its solver is bound by iterations, never by the clock, so the same seed gives the same bytes on any load. A plan that
    came late is counted (`solves.late`); only with `MpcConfig.late_plan = "pid"` is it met by the PID.

    Attributes:
        config: Weights, limits and solver.
        solver_name: Name of the solver in use: the wanted one, or its stand-in.
        solves: How its solves have ended since it was made.

    Args:
        town: Where it drives.
        parameters: Numbers of the car.
        config: Weights, limits and solver.
        control_interval: Time between two decisions [s].
        fallback: Settings of the PID expert that decides where no plan was found; its speeds and its law of where to stop
            are those of the plans, too.

    Raises:
        SolverError: If casadi lacks the solver and the settings name no stand-in.
    """

    name = "mpc"

    def __init__(
        self,
        town: Town,
        *,
        parameters: VehicleParameters | None = None,
        config: MpcConfig | None = None,
        control_interval: float = 0.1,
        fallback: PidConfig | None = None,
    ) -> None:
        self.config = config or MpcConfig()
        self._law = fallback or PidConfig()
        self._town = town
        self._car = parameters or VehicleParameters.default()
        self._drivetrain = Drivetrain.of(self._car)
        self._interval = control_interval
        self._problem = MpcProblem(self.config, self._car, interval=control_interval)
        self._solver = MpcSolver(self._problem, self.config)
        self.solver_name = self._solver.name
        self.solves: SolveCounts = self._solver.counts
        self._pid = PidExpert(
            town, parameters=self._car, config=self._law, control_interval=control_interval
        )
        self._plan: _Plan | None
        self._last: Action | None
        self._handover = Handover(control_interval)
        self._pushes = PushWatch(self._car.max_steering_angle)
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Forget the past; the expert is deterministic, so the seed has no effect."""
        self._pid.reset(seed)
        self._route: Route | None = None
        self._stopping_for = ""
        self._forget()

    def act(self, view: Situation) -> Action:
        """Follow the route for the next control interval."""
        begin = time.thread_time()
        if view.route is not self._route:
            self._take_route(view.route)
        stand_in = self._pid.act(view)
        stop = reference.stop_ahead(
            view,
            self._stops,
            nose_ahead=self._car.length - self._car.rear_overhang,
            config=self._law,
            stopping_for=self._stopping_for,
        )
        self._stopping_for = "" if stop is None else stop.light
        distance = None if stop is None else stop.distance
        if self._is_at_rest(view, distance):
            self._forget()
            return Action(acceleration=-1.0, steering=0.0)
        recovers = self._pushes.look(view, self._last, follows_plan=self._plan is not None)
        is_hard_stop = self._is_hard_stop(view, distance)
        self.solves.recoveries += recovers
        self.solves.hard_stops += is_hard_stop and not recovers
        planned = None if recovers or is_hard_stop else self._planned(view, distance)
        if planned is not None and time.thread_time() - begin > self.config.late_after:
            self.solves.late += 1
            planned = planned if self.config.late_plan == "plan" else None
        if planned is None:
            self._plan = None
            planned = self._handover.take_over(stand_in)
        else:
            self._handover.watch(planned, stand_in)
        self._last = planned
        return planned

    def _forget(self) -> None:
        self._plan = None
        self._last = None
        self._handover.forget()
        self._pushes.forget()

    def _take_route(self, route: Route) -> None:
        self._route = route
        self._stops = reference.stop_lines(self._town, route)
        self._profile = SpeedProfile(
            self._town,
            route,
            config=self._law,
            braking=self.config.braking,
            acceleration=self.config.acceleration,
            max_braking=self.config.max_braking,
        )

    def _is_at_rest(self, view: Situation, distance: float | None) -> bool:
        """Whether the car has come to where it must wait."""
        return distance is not None and distance < HOLD_DISTANCE and view.vehicle.speed < HOLD_SPEED

    def _is_hard_stop(self, view: Situation, distance: float | None) -> bool:
        """Whether a light came so late that a smooth plan would roll over the line."""
        if distance is None:
            return False
        to_line = distance + self._law.stop_gap
        return view.vehicle.speed**2 > 2 * self.config.hard_stop * max(to_line, 0.0)

    def _planned(self, view: Situation, distance: float | None) -> Action | None:
        """The first action of a new plan, or None if there is none."""
        start = self._start(view)
        goal = self._profile.reference(
            station=view.station,
            speed=start.speed,
            distance_to_stop=distance,
            cap=self._recovery_speed(start),
            num_steps=self._problem.num_steps,
            interval=self._interval,
        )
        full_throttle = self._drivetrain.acceleration(1.0, start.speed)
        solution = self._solver.solve(
            self._guess(start, goal),
            self._problem.parameters(start, goal),
            self._problem.bounds(start, full_throttle=full_throttle),
        )
        if solution.status is not SolveStatus.SOLVED:
            return None
        following = self._problem.state(solution.variables, 1)
        self._plan = _Plan(view.time, solution.variables, following)
        return self._action(start, following)

    def _start(self, view: Situation) -> BicycleState:
        """State of the car, with the commands of the last plan in place of what came of them.

        Whoever pushes the car, a disturbance of `collect` first of all, must not become part of the plan: it would be
        commanded again, and on top of it comes the next push.
        """
        vehicle, limit = view.vehicle, self._car.max_steering_angle
        offset, heading_error = frenet_state(view)
        plan = self._plan
        if plan is not None and abs(view.time - plan.time - self._interval) < 1e-6:
            acceleration = plan.following.acceleration
            angle, rate = plan.following.steering_angle, plan.following.steering_rate
        else:
            acceleration, rate = self._driven(vehicle.speed), 0.0
            angle = float(np.clip(vehicle.steering_angle, -limit, limit))
        speed = max(vehicle.speed, 0.0)
        return BicycleState(0.0, offset, heading_error, speed, acceleration, angle, rate)

    def _driven(self, speed: float) -> float:
        """Acceleration that the last pedal has come to, for a plan that follows no plan [m/s2]."""
        if self._last is None or speed < HOLD_SPEED:
            return 0.0
        return self._drivetrain.acceleration(self._last.acceleration, speed)

    def _recovery_speed(self, start: BicycleState) -> float:
        """Speed at which the rack is quick enough to come back to the route [m/s].

        The farther off the car is, or the last plan foresaw that it would come, the slower.
        """
        law, astray = self._law, abs(start.offset)
        if self._plan is not None:
            astray = max(astray, self._problem.largest_offset(self._plan.variables))
        far = law.recovery_offset
        speeds = (law.target_speed, law.recovery_speed, 0.5 * law.recovery_speed)
        return float(np.interp(astray, (0.5 * far, far, 2.0 * far), speeds))

    def _guess(self, start: BicycleState, goal: Reference) -> Float[np.ndarray, " X"]:
        """Where the solver begins: the last plan, one interval later, or the reference itself."""
        if self._plan is not None:
            return self._problem.shifted(self._plan.variables, start)
        return self._problem.along(start, goal)

    def _action(self, start: BicycleState, following: BicycleState) -> Action:
        """Pedal and wheel that bring the car from one state to the next."""
        pedal = self._drivetrain.pedal_towards(
            following.acceleration,
            before=start.acceleration,
            speed=0.5 * (start.speed + following.speed),
            interval=self._interval,
        )
        steering = following.steering_angle / self._car.max_steering_angle
        return Action(acceleration=pedal, steering=float(np.clip(steering, -1.0, 1.0)))
