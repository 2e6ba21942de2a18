"""Frozen settings of the MPC expert: what it weighs, what limits it, and who solves its problem."""

from dataclasses import dataclass
from typing import Literal, get_args

from mjdrive.config.json_files import require
from mjdrive.config.ranges import COUNT, NOT_NEGATIVE, POSITIVE, SOME_SHARE, Range, require_ranges

LatePlan = Literal["plan", "pid"]
"""What is driven when a plan came late."""

_HORIZON = Range("more than 0 and at most 20 s", 0.0, 20.0, includes_least=False)
"""A longer plan takes longer to solve than it is driven."""


@dataclass(frozen=True, slots=True)
class MpcConfig:
    """Settings of the MPC expert; where it must stop and how fast it may go is said by `PidConfig`, for both experts.

    A tolerance is the size of an error that costs as much as any other error of the size of its tolerance: the cost of
    a plan is the sum of all (error / tolerance)^2. A smaller tolerance weighs more.

    Attributes:
        horizon: How far the plan looks ahead; rounded to whole control intervals [s].
        offset_tolerance: Of the distance from the route [m].
        heading_tolerance: Of the heading against the route [rad].
        station_tolerance: Of the progress against the reference [m].
        speed_tolerance: Of the speed against the reference [m/s].
        acceleration_tolerance: Of any acceleration [m/s2].
        jerk_tolerance: Of the rate of the acceleration [m/s3].
        steering_rate_tolerance: Of the rate of the steering angle [rad/s].
        steering_jolt_tolerance: Of the rate of that rate [rad/s2].
        final_offset_tolerance: Of the distance from the route at the end of the plan [m].
        final_heading_tolerance: Of the heading against the route there [rad].
        final_curvature_tolerance: Of the curvature of the car's path against that of the route there [1/m].
        lane_tolerance: Of the body beyond the edge of the lane [m].
        grip_tolerance: Of lateral acceleration beyond its limit [m/s2].
        lane_margin: Space to keep between the body and the edge of the lane on a straight [m].
        lateral_acceleration: Limit of it, softened by grip_tolerance [m/s2].
        acceleration: Largest acceleration of the reference [m/s2].
        braking: Deceleration of the reference towards a stop line or a slower stretch, where there is room for it [m/s2].
        max_jerk: Limit of the rate of the acceleration [m/s3].
        max_braking: Limit of the deceleration [m/s2].
        hard_stop: A light that asks for more deceleration than this is stopped for by the PID, which brakes at once [m/s2].
        steering_rate_share: Part of the car's steering rate that a plan may use [-].
        solver: Name of the solver, one of `mjdrive.expert.mpc_solver.SOLVERS`.
        fallback_solver: Solver to take where casadi lacks a plug-in of the first, or None to refuse.
        max_iterations: Iterations of the solver; a plan that needs more counts as failed [-].
        tolerance: Error of the conditions of optimality at which a plan counts as found [-].
        late_after: A plan is late when its decision, from the situation to the plan, took more CPU time than this [s].
        late_plan: What is driven when a plan came late: "plan" takes it all the same, so that the same seed gives the same bytes on
            any load; "pid" leaves the decision to the PID, as a controller in a car would have to.
    """

    horizon: float = 2.0
    offset_tolerance: float = 0.3
    heading_tolerance: float = 0.3
    station_tolerance: float = 0.2
    speed_tolerance: float = 0.1
    acceleration_tolerance: float = 0.6
    jerk_tolerance: float = 0.6
    steering_rate_tolerance: float = 0.15
    steering_jolt_tolerance: float = 1.0
    final_offset_tolerance: float = 0.1
    final_heading_tolerance: float = 0.02
    final_curvature_tolerance: float = 0.05
    lane_tolerance: float = 0.05
    grip_tolerance: float = 0.3
    lane_margin: float = 0.2
    lateral_acceleration: float = 3.5
    acceleration: float = 1.8
    braking: float = 2.0
    max_jerk: float = 10.0
    max_braking: float = 7.0
    hard_stop: float = 3.5
    steering_rate_share: float = 0.9
    solver: str = "fatrop"
    fallback_solver: str | None = None
    max_iterations: int = 30
    tolerance: float = 1e-4
    late_after: float = 0.05
    late_plan: LatePlan = "plan"

    def __post_init__(self) -> None:
        positive = (
            "lateral_acceleration", "acceleration", "braking", "max_jerk", "max_braking", "hard_stop", "late_after",
            *(name for name in self.__slots__ if name.endswith("tolerance")),
        )  # fmt: skip
        require_ranges(
            self,
            {
                **dict.fromkeys(positive, POSITIVE),
                "horizon": _HORIZON,
                "lane_margin": NOT_NEGATIVE,
                "steering_rate_share": SOME_SHARE,
                "max_iterations": COUNT,
            },
        )
        for name in ("max_braking", "hard_stop"):
            value = getattr(self, name)
            require(
                value >= self.braking,
                f"{name} is {value} m/s2; expected at least braking ({self.braking} m/s2).",
            )
        require(
            self.late_plan in get_args(LatePlan),
            f"late_plan is '{self.late_plan}'; expected one of {', '.join(get_args(LatePlan))}.",
        )
