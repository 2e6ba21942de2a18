"""The nouns. SI units throughout; every array is read-only once it is inside one of these.

World frame: x east, y north, z up (OpenDRIVE axes; CARLA's y is minus ours). Vehicle frame: x forward, y left, z up
(ISO 8855), origin on the ground under the centre of the rear axle. Yaw is counter-clockwise from world +x, in (-pi, pi].
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import IntEnum
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float, UInt8

View_contra = TypeVar("View_contra", contravariant=True)


class Signal(IntEnum):
    """What a traffic light shows."""

    GREEN = 0
    YELLOW = 1
    RED = 2


class Move(IntEnum):
    """Which way a lane leads through a junction; `FOLLOW` outside junctions."""

    FOLLOW = 0
    LEFT = 1
    STRAIGHT = 2
    RIGHT = 3


class InfractionKind(IntEnum):
    """What the rules hold against a drive."""

    RED_LIGHT = 0
    COLLISION = 1
    OFF_ROAD = 2
    KERB = 3


def _freeze_arrays(instance: object) -> None:
    """Make read-only copies of the array fields of a frozen dataclass."""
    for field in fields(instance):  # type: ignore[arg-type]
        value = getattr(instance, field.name)
        if isinstance(value, np.ndarray) and value.flags.writeable:
            frozen = value.copy()
            frozen.flags.writeable = False
            object.__setattr__(instance, field.name, frozen)


@dataclass(frozen=True, slots=True, eq=False)
class Lane:
    """One driving lane, in its direction of travel.

    Attributes:
        id: Unique name, "road/section/lane" of the OpenDRIVE map.
        centerline: Centre line in the world frame, shape (N, 2) [m], ordered along travel.
        width: Mean width [m].
        successors: Names of the lanes that follow.
        junction: Name of the junction that the lane crosses, or None outside junctions.
        light: Name of the traffic light at the end of the lane, or None.
        move: Which way the lane leads through its junction.
    """

    id: str
    centerline: Float[np.ndarray, "N 2"]
    width: float
    successors: tuple[str, ...]
    junction: str | None
    light: str | None
    move: Move = Move.FOLLOW

    def __post_init__(self) -> None:
        _freeze_arrays(self)


@dataclass(frozen=True, slots=True, eq=False)
class TrafficLight:
    """One light: the approach lanes that it stops, and its cycle.

    Attributes:
        id: Unique name (the OpenDRIVE signal).
        lane: Name of the approach lane that ends at the stop line.
        junction: Name of the junction that it guards.
        stop_line: Left and right end of the stop line across the full lane, world frame, shape (2, 2) [m].
        yaw: Direction of travel at the stop line [rad].
        pole: Where the pole stands, world frame, shape (2,) [m].
        program: One cycle: signals and how long each is shown [s].
        offset: Time into the cycle at clock zero [s].
    """

    id: str
    lane: str
    junction: str
    stop_line: Float[np.ndarray, "2 2"]
    yaw: float
    pole: Float[np.ndarray, "2"]
    program: tuple[tuple[Signal, float], ...]
    offset: float

    def __post_init__(self) -> None:
        _freeze_arrays(self)


@dataclass(frozen=True, slots=True, eq=False)
class Town:
    """A road network that can be driven.

    Attributes:
        name: Name of its folder in assets/towns.
        lanes: Every driving lane by name.
        lights: Every traffic light by name.
        bounds: Smallest x, smallest y, largest x, largest y of the lanes [m].
        digest: SHA-256 of the map and of town.json, hexadecimal.
    """

    name: str
    lanes: Mapping[str, Lane]
    lights: Mapping[str, TrafficLight]
    bounds: Float[np.ndarray, "4"]
    digest: str

    def __post_init__(self) -> None:
        _freeze_arrays(self)


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """A dense path to follow, points 1 m apart (the last gap may be shorter).

    Attributes:
        lanes: Names of the lanes in order.
        points: World frame, shape (N, 2) [m].
        station: Arc length from the start, shape (N,) [m].
        yaw: Direction of travel, shape (N,) [rad].
        curvature: Positive to the left, shape (N,) [1/m].
        lane_index: Index into `lanes` for each point, shape (N,).
    """

    lanes: tuple[str, ...]
    points: Float[np.ndarray, "N 2"]
    station: Float[np.ndarray, " N"]
    yaw: Float[np.ndarray, " N"]
    curvature: Float[np.ndarray, " N"]
    lane_index: np.ndarray

    def __post_init__(self) -> None:
        _freeze_arrays(self)


@dataclass(frozen=True, slots=True)
class VehicleState:
    """Where the car is and how it moves.

    Attributes:
        x: Rear-axle centre, world frame [m].
        y: Rear-axle centre, world frame [m].
        yaw: Heading in (-pi, pi] [rad].
        speed: Forward speed of the rear-axle centre [m/s].
        yaw_rate: Counter-clockwise [rad/s].
        steering_angle: Centre steering angle of the front wheels, positive to the left [rad].
    """

    x: float
    y: float
    yaw: float
    speed: float
    yaw_rate: float
    steering_angle: float


@dataclass(frozen=True, slots=True)
class Action:
    """What a policy decides, ten times a second. Array order is (acceleration, steering).

    Attributes:
        acceleration: In [-1, 1]; positive is throttle, negative is brake [-].
        steering: In [-1, 1]; positive turns left [-].
    """

    acceleration: float
    steering: float


@dataclass(frozen=True, slots=True, eq=False)
class Observation:
    """All that a learned policy may see.

    Attributes:
        bev: Bird's-eye view: road, lane lines, lights 1.5 s ago, 0.8 s ago and now, shape (5, 192, 192) [-].
        state: Speed [m/s], previous acceleration [-] and previous steering [-], shape (3,).
    """

    bev: UInt8[np.ndarray, "5 192 192"]
    state: Float[np.ndarray, "3"]

    def __post_init__(self) -> None:
        _freeze_arrays(self)


@dataclass(frozen=True, slots=True, eq=False)
class Situation:
    """The truth: what experts, rules, metrics and viewers may see, and learned policies may not.

    Attributes:
        time: Simulation time since reset [s].
        vehicle: State of the car.
        route: The path to follow.
        station: Progress of the car along the route [m].
        offset: Signed distance of the car from the route, positive to the left [m].
        lights: What every light shows now, by name.
    """

    time: float
    vehicle: VehicleState
    route: Route
    station: float
    offset: float
    lights: Mapping[str, Signal]


@dataclass(frozen=True, slots=True)
class Infraction:
    """One breach of the rules.

    Attributes:
        kind: What happened.
        time: Simulation time since reset [s].
        x: Rear-axle centre, world frame [m].
        y: Rear-axle centre, world frame [m].
        object: The light that was run or the thing that was hit; empty off the road.
    """

    kind: InfractionKind
    time: float
    x: float
    y: float
    object: str


@dataclass(frozen=True, slots=True, eq=False)
class Episode:
    """One drive, step by step; the bird's-eye view is recomputed from it and never stored.

    Row t of every array is what was true when action t was chosen.

    Attributes:
        town: Name of the town.
        policy: Name of the policy that drove.
        seed: Seed of the episode.
        light_phase: Time into the light cycle at the start [s].
        time: Simulation time since reset, shape (T,) [s].
        physics: Full MuJoCo integration state, shape (T, S), mixed units of qpos, qvel and act.
        vehicle: x, y [m], yaw [rad], speed [m/s], yaw_rate [rad/s], steering_angle [rad], shape (T, 6).
        actions: Driven acceleration and steering, shape (T, 2) [-].
        labels: What the policy wanted before any disturbance, shape (T, 2) [-].
        on_lane: Whether the car was on a driving lane, shape (T,).
        infractions: In the order in which they happened.
        metadata: Versions, digests and settings that the episode was made from.
    """

    town: str
    policy: str
    seed: int
    light_phase: float
    time: Float[np.ndarray, " T"]
    physics: Float[np.ndarray, "T S"]
    vehicle: Float[np.ndarray, "T 6"]
    actions: Float[np.ndarray, "T 2"]
    labels: Float[np.ndarray, "T 2"]
    on_lane: np.ndarray
    infractions: tuple[Infraction, ...]
    metadata: Mapping[str, str]

    def __post_init__(self) -> None:
        _freeze_arrays(self)


@runtime_checkable
class Policy(Protocol[View_contra]):
    """Chooses actions; a learned policy is a `Policy[Observation]`, an expert a `Policy[Situation]`."""

    @property
    def name(self) -> str:
        """How summaries and files call it."""

    def reset(self, seed: int) -> None:
        """Forget the past and start a new stream of random numbers."""

    def act(self, view: View_contra) -> Action:
        """Choose the action for the next 0.1 s."""
