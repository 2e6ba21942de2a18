"""The optimal control problem of the MPC expert, as casadi symbols in the order of its stages.

    minimise    sum of (error / tolerance)^2 over the horizon
    subject to  x[k+1] = bicycle.step(x[k], u[k]),  x[0] given                     multiple shooting
                |offset| <= lane + slack,  |lateral acceleration| <= limit + slack
                |steering angle|, |steering rate|, acceleration, jerk bounded

The order x[0] u[0] x[1] u[1] ... x[N], with the constraints of stage k after its dynamics, is what the structured
solvers (fatrop, HPIPM) look for; the others do not mind it.

Reference:
    Bock and Plitt, A multiple shooting algorithm for direct solution of optimal control problems, IFAC 1984; Bryson
    and Ho, Applied Optimal Control, 1975 (weights from tolerances).
"""

from typing import NamedTuple

import casadi as ca
import numpy as np
from jaxtyping import Float

from mjdrive.config import MpcConfig
from mjdrive.expert.speed_profile import Reference
from mjdrive.vehicle.bicycle import Bicycle, BicycleInput, BicycleState, Trigonometry
from mjdrive.vehicle.parameters import VehicleParameters

SYMBOLS = Trigonometry(ca.sin, ca.cos, ca.tan)
NUM_STATES = len(BicycleState._fields)
NUM_INPUTS = len(BicycleInput._fields)
NUM_SLACKS = 2


class Bounds(NamedTuple):
    """Lower and upper limits of the variables and of the constraints."""

    lbx: Float[np.ndarray, " X"]
    ubx: Float[np.ndarray, " X"]
    lbg: Float[np.ndarray, " G"]
    ubg: Float[np.ndarray, " G"]


class MpcProblem:
    """One problem for all decisions: what changes between them are its parameters and bounds.

    Attributes:
        num_steps: Control intervals N of the horizon [-].
        symbols: x, f, g and p for `casadi.nlpsol`.
        equality: Which constraints are equations.
        state_index: Place of each state among the variables, shape (N + 1, 7).
        input_index: Place of each input among the variables, shape (N, 2).

    Args:
        config: Weights and limits.
        car: Numbers of the car.
        interval: Time between two decisions [s].
    """

    def __init__(self, config: MpcConfig, car: VehicleParameters, *, interval: float) -> None:
        self.num_steps = max(round(config.horizon / interval), 2)
        self._config, self._car, self._interval = config, car, interval
        self._bicycle = Bicycle.of(car)
        self._variables: list[ca.SX] = []
        self._num_variables = 0
        self._constraints: list[ca.SX] = []
        self._limits: list[tuple[float, float]] = []
        self._residuals: list[ca.SX] = []
        self.state_index = np.zeros((self.num_steps + 1, NUM_STATES), int)
        self.input_index = np.zeros((self.num_steps, NUM_INPUTS), int)
        self._build()

    def _build(self) -> None:
        steps = self.num_steps
        start = ca.SX.sym("start", NUM_STATES)
        reference = ca.SX.sym("reference", 4, steps)  # station, speed, curvature, lane width
        state = self._new("x0", self.state_index[0])
        for k in range(steps):
            drive = BicycleInput(*ca.vertsplit(self._new(f"u{k}", self.input_index[k])))
            slack = self._slack(k) if k > 0 else None
            following = self._new(f"x{k + 1}", self.state_index[k + 1])
            here = BicycleState(*ca.vertsplit(state))
            predicted = self._bicycle.step(
                here, drive, interval=self._interval, curvature=reference[2, k], maths=SYMBOLS
            )
            self._require(following - ca.vertcat(*predicted), 0.0, 0.0)
            if k == 0:
                self._require(state - start, 0.0, 0.0)
            if slack is not None:
                self._soften(here, slack, reference[3, k - 1])
            self._weigh(BicycleState(*ca.vertsplit(following)), drive, reference[:2, k])
            state = following
        self._weigh_end(BicycleState(*ca.vertsplit(state)), reference[2, steps - 1])
        residual = ca.vertcat(*self._residuals)
        self.symbols = {
            "x": ca.vertcat(*self._variables),
            "f": ca.sumsqr(residual),
            "g": ca.vertcat(*self._constraints),
            "p": ca.vertcat(start, ca.vec(reference)),
        }
        self.equality = [low == high for low, high in self._limits]

    def _new(self, name: str, index: np.ndarray) -> ca.SX:
        index[:] = np.arange(self._num_variables, self._num_variables + len(index))
        return self._add(name, len(index))

    def _slack(self, k: int) -> ca.SX:
        return self._add(f"slack{k}", NUM_SLACKS)

    def _add(self, name: str, size: int) -> ca.SX:
        symbol = ca.SX.sym(name, size)
        self._variables.append(symbol)
        self._num_variables += size
        return symbol

    def _require(self, expression: ca.SX, low: float, high: float) -> None:
        self._constraints.append(expression)
        self._limits += [(low, high)] * expression.numel()

    def _soften(self, state: BicycleState, slack: ca.SX, lane_width: ca.SX) -> None:
        """Lane and grip may be left at a price, so that every start has a plan."""
        config, car = self._config, self._car
        free = 0.5 * (lane_width - car.width) - config.lane_margin
        turn = self._bicycle.path_curvature(state.steering_angle, state.speed, SYMBOLS)
        sideways = turn * state.speed**2
        beyond_lane, beyond_grip = ca.vertsplit(slack)
        for value, limit, beyond in (
            (state.offset, free, beyond_lane),
            (sideways, config.lateral_acceleration, beyond_grip),
        ):
            self._require(value - limit - beyond, -np.inf, 0.0)
            self._require(-value - limit - beyond, -np.inf, 0.0)
        self._residuals += [
            beyond_lane / config.lane_tolerance,
            beyond_grip / config.grip_tolerance,
        ]

    def _weigh(self, state: BicycleState, drive: BicycleInput, reference: ca.SX) -> None:
        config = self._config
        self._residuals += [
            (state.station - reference[0]) / config.station_tolerance,
            state.offset / config.offset_tolerance,
            state.heading_error / config.heading_tolerance,
            (state.speed - reference[1]) / config.speed_tolerance,
            state.acceleration / config.acceleration_tolerance,
            state.steering_rate / config.steering_rate_tolerance,
            drive.jerk / config.jerk_tolerance,
            drive.steering_jolt / config.steering_jolt_tolerance,
        ]

    def _weigh_end(self, state: BicycleState, curvature: ca.SX) -> None:
        """Price of what a plan leaves behind: a slow car sees only metres ahead, and must not end across the road."""
        config = self._config
        turn = self._bicycle.path_curvature(state.steering_angle, state.speed, SYMBOLS)
        self._residuals += [
            state.offset / config.final_offset_tolerance,
            state.heading_error / config.final_heading_tolerance,
            (turn - curvature) / config.final_curvature_tolerance,
        ]

    def parameters(self, start: BicycleState, reference: Reference) -> Float[np.ndarray, " P"]:
        """Values of the parameters for one decision.

        Args:
            start: State of the car, its station counted from the car [m].
            reference: What to follow.

        Returns:
            Start and reference in the order of `symbols["p"]`.
        """
        rows = np.stack(
            [
                reference.station[1:] - reference.station[0],
                reference.speed[1:],
                reference.curvature,
                reference.lane_width[1:],
            ]
        )
        return np.concatenate([np.array(start, float), rows.ravel(order="F")])

    def bounds(self, start: BicycleState, *, full_throttle: float) -> Bounds:
        """Limits for one decision; whatever the start, holding the wheel and easing the pedal keeps them.

        Args:
            start: State of the car.
            full_throttle: Largest acceleration of the car at its speed [m/s2].

        Returns:
            Limits of variables and constraints.
        """
        config, car = self._config, self._car
        upper = np.full(self._num_variables, np.inf)
        lower = -upper
        later = self.state_index[1:]
        rate = config.steering_rate_share * car.max_steering_rate
        for name, low, high in (
            ("steering_angle", -car.max_steering_angle, car.max_steering_angle),
            ("steering_rate", -rate, rate),
            (
                "acceleration",
                min(-config.max_braking, start.acceleration),
                max(full_throttle, start.acceleration),
            ),
        ):
            column = later[:, BicycleState._fields.index(name)]
            lower[column], upper[column] = low, high
        jerk = self.input_index[:, BicycleInput._fields.index("jerk")]
        lower[jerk], upper[jerk] = -config.max_jerk, config.max_jerk
        limits = np.array(self._limits)
        return Bounds(lower, upper, limits[:, 0], limits[:, 1])

    def state(self, variables: Float[np.ndarray, " X"], k: int) -> BicycleState:
        """State number k of a plan; its station is counted from the car [m]."""
        return BicycleState(*variables[self.state_index[k]].tolist())

    def largest_offset(self, variables: Float[np.ndarray, " X"]) -> float:
        """Farthest from the route that a plan comes [m]."""
        column = self.state_index[:, BicycleState._fields.index("offset")]
        return float(np.abs(variables[column]).max())

    def along(self, start: BicycleState, reference: Reference) -> Float[np.ndarray, " X"]:
        """A first guess: the car follows the reference without an error."""
        guess = np.zeros(self._num_variables)
        guess[self.state_index[0]] = start
        angle = np.arctan(self._car.wheelbase * reference.curvature)
        limit = self._car.max_steering_angle
        for name, values in (
            ("station", reference.station[1:] - reference.station[0]),
            ("speed", reference.speed[1:]),
            ("steering_angle", np.clip(angle, -limit, limit)),
        ):
            guess[self.state_index[1:, BicycleState._fields.index(name)]] = values
        return guess

    def shifted(
        self, variables: Float[np.ndarray, " X"], start: BicycleState
    ) -> Float[np.ndarray, " X"]:
        """A guess from the plan before: one interval later, counted from where the car is now."""
        guess = variables.copy()
        for index in (self.state_index[1:], self.input_index):
            guess[index[:-1]] = variables[index[1:]]
        station = BicycleState._fields.index("station")
        guess[self.state_index[1:, station]] -= variables[self.state_index[1, station]]
        guess[self.state_index[0]] = start
        return guess
