"""Settings of collecting demonstrations."""

import math
from dataclasses import dataclass, field

from mjdrive.config.json_files import require
from mjdrive.config.mpc import MpcConfig
from mjdrive.config.settings import PidConfig

ExpertName = str
"""Name of an expert: "pid", "mpc", or one that another package brings along."""


@dataclass(frozen=True, slots=True)
class DisturbanceConfig:
    """How the driven action is disturbed while the clean one stays the label.

    Attributes:
        steering_rate_per_min: Steering pulses that start per minute of quiet driving [1/min].
        steering_amplitude: Largest peak of a pulse; the smallest is a third of it [-].
        steering_duration: Length of a pulse [s].
        stop_rate_per_min: Short stops per minute [1/min].
        stop_duration: Length of a stop's braking [s].
        stop_brake: Brake command of a stop [-].
        throttle_rate_per_min: Pulses on the acceleration command, of either sign, per minute of quiet driving [1/min].
        throttle_amplitude: Largest peak of such a pulse; the smallest is a third of it [-].
        throttle_duration: Length of such a pulse [s].
    """

    steering_rate_per_min: float = 15.0
    steering_amplitude: float = 0.5
    steering_duration: float = 1.4
    stop_rate_per_min: float = 1.5
    stop_duration: float = 2.5
    stop_brake: float = 0.4
    throttle_rate_per_min: float = 0.0
    throttle_amplitude: float = 0.5
    throttle_duration: float = 1.0

    def __post_init__(self) -> None:
        for name in ("steering_amplitude", "stop_brake", "throttle_amplitude"):
            value = getattr(self, name)
            require(0 <= value <= 1, f"{name} is {value}; expected a command in [0, 1].")
        for name in ("steering_rate_per_min", "stop_rate_per_min", "throttle_rate_per_min"):
            value = getattr(self, name)
            require(
                0 <= value < math.inf,
                f"{name} is {value} a minute; expected 0 or more, not infinite.",
            )
        for name in ("steering_duration", "stop_duration", "throttle_duration"):
            value = getattr(self, name)
            require(0 < value < math.inf, f"{name} is {value} s; expected a time that lasts.")


@dataclass(frozen=True, slots=True)
class CollectConfig:
    """How demonstrations are collected.

    Attributes:
        routes: Names of the routes to drive, in order; empty for all of the town.
        repeats: Times that each route is driven, with other lights and disturbances [-].
        episodes: Drives in all, the routes in turn and again from the first, or None for every route `repeats` times;
            with a random walk, the drives that it is cut into, or None for one a km [-].
        random_walk_km: Drive so far with random turns instead of along the routes; 0 for the routes [km].
        disturbance: How the drive is disturbed, or None for the paper's noise-free demonstrations.
        expert: Who drives: "pid", "mpc", or an expert of another package.
        pid: Settings of the PID expert; its speeds and its law of where to stop hold for the other, too.
        mpc: Settings of the MPC expert.
        step_limit_per_metre: Control steps allowed per metre of route before the expert counts as stuck [1/m].
    """

    routes: tuple[str, ...] = ()
    repeats: int = 1
    episodes: int | None = None
    random_walk_km: float = 0.0
    disturbance: DisturbanceConfig | None = DisturbanceConfig()
    expert: ExpertName = "pid"
    pid: PidConfig = field(default_factory=PidConfig)
    mpc: MpcConfig = field(default_factory=MpcConfig)
    step_limit_per_metre: float = 10.0

    def __post_init__(self) -> None:
        require(
            len(set(self.routes)) == len(self.routes),
            f"routes are {', '.join(self.routes)}; expected each at most once.",
        )
        require(self.repeats >= 1, f"repeats is {self.repeats}; expected at least 1.")
        require(
            self.episodes is None or self.episodes >= 1,
            f"episodes is {self.episodes}; expected at least 1.",
        )
        require(
            0 <= self.random_walk_km < math.inf,
            f"random_walk_km is {self.random_walk_km} km; expected 0 or more, not infinite.",
        )
        require(
            not (self.random_walk_km and self.routes),
            f"routes are {', '.join(self.routes)} and random_walk_km is {self.random_walk_km} km; expected one of them.",
        )
        require(
            0 < self.step_limit_per_metre < math.inf,
            f"step_limit_per_metre is {self.step_limit_per_metre}; expected a positive number.",
        )
