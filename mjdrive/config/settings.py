"""Frozen settings of everything that is not learnt: one sentence and unit a field, checked when they are made."""

import math
from dataclasses import dataclass
from typing import Literal

from mjdrive.config.json_files import require
from mjdrive.config.ranges import (
    COUNT,
    FINITE,
    NOT_NEGATIVE,
    POSITIVE,
    SHARE,
    require_ranges,
)

ExtraLayer = Literal["route", "sidewalks", "buildings", "vehicles"]
"""A channel that the bird's-eye view can have beside the paper's five."""


@dataclass(frozen=True, slots=True)
class BevConfig:
    """How the bird's-eye view is drawn (defaults: the paper's).

    Attributes:
        size_px: Width and height of the picture [px].
        pixels_per_metre: Resolution [px/m].
        ego_above_bottom_px: Row of the vehicle origin, counted from the lower edge [px].
        history_steps: Control steps back to each light channel, oldest first; 0 is now [-].
        light_width_share: Length of a drawn stop line over the lane width [-].
        light_thickness_px: Thickness of a drawn stop line [px].
        road_outline_px: Width of the line drawn around each lane of the road channel, odd or 0: two lanes of 4 m become
            a road of 9.0 m with 5, as the paper's [px].
        origin_ahead_of_rear_axle: Where the picture's ego point lies on the car, ahead of the rear axle [m].
        light_range: Lights whose stop line is farther from the ego point are not drawn [m].
        light_values: "grey" draws green, yellow and red as 80, 170 and 255; "binary" draws red alone, as 255.
        extra_layers: Channels after the five, in this order: any of "route", "sidewalks", "buildings", "vehicles".
    """

    size_px: int = 192
    pixels_per_metre: float = 5.0
    ego_above_bottom_px: int = 40
    history_steps: tuple[int, int, int] = (15, 8, 0)
    light_width_share: float = 0.8
    light_thickness_px: int = 6
    road_outline_px: int = 5
    origin_ahead_of_rear_axle: float = 1.35
    light_range: float = 50.0
    light_values: Literal["grey", "binary"] = "grey"
    extra_layers: tuple[ExtraLayer, ...] = ()

    def __post_init__(self) -> None:
        require(self.size_px >= 16, f"size_px is {self.size_px}; expected at least 16.")
        require_ranges(
            self,
            {
                "pixels_per_metre": POSITIVE,
                "ego_above_bottom_px": FINITE,
                "history_steps": NOT_NEGATIVE,
                "light_width_share": POSITIVE,
                "light_thickness_px": COUNT,
                "road_outline_px": NOT_NEGATIVE,
                "origin_ahead_of_rear_axle": FINITE,
            },
        )
        require(
            self.road_outline_px == 0 or self.road_outline_px % 2 == 1,
            f"road_outline_px is {self.road_outline_px}; expected 0 or an odd number.",
        )
        require(self.light_range > 0, f"light_range is {self.light_range} m; expected over 0.")
        require(
            len(set(self.extra_layers)) == len(self.extra_layers),
            f"extra_layers is {self.extra_layers}; expected each name at most once.",
        )


@dataclass(frozen=True, slots=True)
class SimulationConfig:
    """How the world is stepped.

    Attributes:
        timestep: Length of one physics step [s].
        control_interval: Time between two decisions [s].
        car_update_interval: Time between two updates of tyre, brake and drag parameters [s].
    """

    timestep: float = 0.005
    control_interval: float = 0.1
    car_update_interval: float = 0.02

    def __post_init__(self) -> None:
        require_ranges(self, dict.fromkeys(self.__slots__, POSITIVE))
        for longer, shorter in (
            ("control_interval", "car_update_interval"),
            ("car_update_interval", "timestep"),
        ):
            ratio = getattr(self, longer) / getattr(self, shorter)
            require(
                ratio >= 1 and abs(ratio - round(ratio)) < 1e-9,
                f"{longer} is {getattr(self, longer)} s and {shorter} is {getattr(self, shorter)} s; "
                f"expected a whole number of the second in the first.",
            )


@dataclass(frozen=True, slots=True)
class RulesConfig:
    """Limits of the rules (defaults: Leaderboard 1.0).

    Attributes:
        light_distance: Lights farther from the car than this are not looked at; Roach has 30 [m].
        stop_line_share: Half length of the watched stop line over the lane width; 0.6 in newer Leaderboards [-].
        stop_line_sweep: Whether a car that moves farther in a step than its tail is long can be seen to cross;
            without it, as in the Leaderboard, crossings above about 52 km/h may be missed.
        same_hit_time: A touch of the same thing within this time of the last one is no new collision [s].
        same_hit_distance: Nor is one within this distance of the last one [m].
        back_on_road: An excursion off the road ends when the centre of the car is this far inside again [m].
        wrong_way_angle: A lane fits while the heading of the car is within this angle of its direction [rad].
        wrong_way_distance: Path against the lanes that makes a wrong way, about a car length [m].
        stuck_speed: Below this the car stands [m/s].
        stuck_time: A standstill of this length is being stuck [s].
    """

    light_distance: float = 15.0
    stop_line_share: float = 0.4
    stop_line_sweep: bool = True
    same_hit_time: float = 5.0
    same_hit_distance: float = 3.0
    back_on_road: float = 0.5
    wrong_way_angle: float = math.radians(120.0)
    wrong_way_distance: float = 5.0
    stuck_speed: float = 0.1
    stuck_time: float = 180.0

    def __post_init__(self) -> None:
        require(
            0 < self.stop_line_share <= 1,
            f"stop_line_share is {self.stop_line_share}; expected a share of the lane width in (0, 1].",
        )
        require(
            math.pi / 2 <= self.wrong_way_angle < math.pi,
            f"wrong_way_angle is {self.wrong_way_angle} rad; expected pi/2 or more, and less than pi.",
        )
        for name in ("light_distance", "stuck_speed", "stuck_time"):
            value = getattr(self, name)
            require(value > 0, f"{name} is {value}; expected a positive number.")
        for name in ("same_hit_time", "same_hit_distance", "back_on_road", "wrong_way_distance"):
            value = getattr(self, name)
            require(value >= 0, f"{name} is {value}; expected 0 or more.")


@dataclass(frozen=True, slots=True)
class PidConfig:
    """Settings of the PID expert.

    Structure and speeds are those of the paper's expert; the gains are re-tuned to this car, whose full lock is
    0.60 rad where CARLA's is about 0.66 rad on average and whose rack moves at 0.48 rad/s.

    Attributes:
        target_speed: Speed on straight roads [m/s].
        turn_speed: Speed in turns and bends [m/s].
        turn_radius: A route tighter than this is a turn [m].
        lateral_acceleration: Tight turns are driven slower than turn_speed to stay below this [m/s2].
        speed_gains: P [1/(m/s)], I [1/m] and D [1/(m/s2)] on the speed error.
        steering_gains: P [1/rad], I [1/(rad s)] and D [s/rad] on the heading angle to the target point.
        integral_window: Number of past errors that the integral sees [-].
        target_distance: Distance to the target point on the route [m].
        turn_target_distance: The same while entering a turn [m].
        throttle_cut: Smallest factor on the throttle while steering [-].
        braking: Deceleration planned towards a stop line or a slower stretch [m/s2].
        brake_gain: Brake per speed error above the plan [1/(m/s)].
        stop_gap: Distance between the nose and the stop line at rest [m].
        recovery_offset: Farther from the route than this, the expert slows down to come back [m].
        recovery_speed: Speed until it is back [m/s].
        late_braking: A light that changes too late is passed when stopping would need more than this [m/s2].
    """

    target_speed: float = 6.0
    turn_speed: float = 4.5
    turn_radius: float = 30.0
    lateral_acceleration: float = 2.5
    speed_gains: tuple[float, float, float] = (0.5, 0.025, 0.1)
    steering_gains: tuple[float, float, float] = (2.2, 0.05, 0.0)
    integral_window: int = 30
    target_distance: float = 5.0
    turn_target_distance: float = 5.5
    throttle_cut: float = 0.25
    braking: float = 2.5
    brake_gain: float = 0.5
    stop_gap: float = 1.0
    recovery_offset: float = 0.8
    recovery_speed: float = 3.0
    late_braking: float = 5.0

    def __post_init__(self) -> None:
        for name in ("speed_gains", "steering_gains"):
            gains = getattr(self, name)
            require(
                len(gains) == 3,
                f"{name} is {gains}; expected three numbers: P, I and D.",
            )
        positive = (
            "target_speed", "turn_speed", "turn_radius", "lateral_acceleration", "target_distance", "turn_target_distance",
            "braking", "brake_gain", "recovery_speed", "late_braking",
        )  # fmt: skip
        not_negative = ("speed_gains", "steering_gains", "stop_gap", "recovery_offset")
        require_ranges(
            self,
            {
                **dict.fromkeys(positive, POSITIVE),
                **dict.fromkeys(not_negative, NOT_NEGATIVE),
                "integral_window": COUNT,
                "throttle_cut": SHARE,
            },
        )
        for name in ("speed_gains", "steering_gains"):
            gains = getattr(self, name)
            require(gains[0] > 0, f"{name} is {gains}; expected P, the first, to be more than 0.")
        require(
            self.turn_speed <= self.target_speed,
            f"turn_speed is {self.turn_speed} m/s; expected at most target_speed ({self.target_speed} m/s).",
        )
