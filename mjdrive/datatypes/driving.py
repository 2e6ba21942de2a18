"""Nouns of a drive: what the car does, what policies see, and what is recorded."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.datatypes.arrays import freeze_arrays
from mjdrive.datatypes.town import Route, Signal

View_contra = TypeVar("View_contra", contravariant=True)


class InfractionKind(IntEnum):
    """What the rules hold against a drive."""

    RED_LIGHT = 0
    COLLISION = 1
    OFF_ROAD = 2
    KERB = 3
    WRONG_WAY = 4
    STUCK = 5


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
        freeze_arrays(self)


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
        cause: The light that was run, the thing that was hit, the lane that was left or driven against, or "standstill".
    """

    kind: InfractionKind
    time: float
    x: float
    y: float
    cause: str


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
        physics: What `Car.restore` needs to drive on from here bit by bit, MuJoCo's integration state first, shape (T, S), mixed units.
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
        freeze_arrays(self)


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
