"""Nouns of a town: lanes, lights and what stands or is painted beside them."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes.arrays import freeze_arrays


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
        widths: Width at each point of the centre line, shape (N,) [m]; `width` everywhere if None.
        left: Name of the lane beside it on the left in the same direction, or None.
        right: Name of the lane beside it on the right in the same direction, or None.
    """

    id: str
    centerline: Float[np.ndarray, "N 2"]
    width: float
    successors: tuple[str, ...]
    junction: str | None
    light: str | None
    move: Move = Move.FOLLOW
    widths: Float[np.ndarray, " N"] | None = None
    left: str | None = None
    right: str | None = None

    def __post_init__(self) -> None:
        freeze_arrays(self)


@dataclass(frozen=True, slots=True, eq=False)
class TrafficLight:
    """One light: the approach lane that it stops, and its cycle.

    A signal of the map that stops several lanes is as many lights, which share pole and program.

    Attributes:
        id: Unique name: that of the signal, with the name of the lane behind it where the signal stops several.
        lane: Name of the approach lane that ends at the stop line.
        junction: Name of the junction that it guards.
        stop_line: Left and right end of the stop line across the full lane, world frame, shape (2, 2) [m].
        yaw: Direction of travel at the stop line [rad].
        pole: Where the pole stands, world frame, shape (2,) [m].
        program: One cycle: signals and how long each is shown [s].
        offset: Time into the cycle at clock zero [s].
        signal: Name of the OpenDRIVE signal; `id` if empty.
    """

    id: str
    lane: str
    junction: str
    stop_line: Float[np.ndarray, "2 2"]
    yaw: float
    pole: Float[np.ndarray, "2"]
    program: tuple[tuple[Signal, float], ...]
    offset: float
    signal: str = ""

    def __post_init__(self) -> None:
        freeze_arrays(self)


@dataclass(frozen=True, slots=True, eq=False)
class Marking:
    """A painted line on the road.

    Attributes:
        points: Its middle in the world frame, shape (N, 2) [m].
        width: Of the paint [m].
        color: "white", "yellow", "blue", "red", "green" or "orange".
        dash: Length of a dash, 0 for an unbroken line [m].
        gap: Between two dashes [m].
    """

    points: Float[np.ndarray, "N 2"]
    width: float
    color: str = "white"
    dash: float = 0.0
    gap: float = 0.0

    def __post_init__(self) -> None:
        freeze_arrays(self)


@dataclass(frozen=True, slots=True)
class Sign:
    """A traffic sign beside the road.

    Attributes:
        id: Name of the OpenDRIVE signal.
        type: OpenDRIVE type; "274" is a speed limit.
        value: Number on the sign, -1 if none [-].
        unit: Unit of the number, for example "km/h".
        x: Where it stands, world frame [m].
        y: Where it stands, world frame [m].
        yaw: Direction of travel of the traffic that it is for [rad].
    """

    id: str
    type: str
    value: float
    unit: str
    x: float
    y: float
    yaw: float


@dataclass(frozen=True, slots=True, eq=False)
class StaticObject:
    """A thing of the map that stands still: a building, a tree, a barrier, or a crosswalk on the ground.

    Attributes:
        id: Name of the OpenDRIVE object.
        type: OpenDRIVE type: "building", "tree", "pole", "barrier", "crosswalk", "parkingSpace" and others.
        outline: Ground that it covers, world frame, counter-clockwise, shape (N, 2) [m].
        height: Above the ground; 0 for paint [m].
    """

    id: str
    type: str
    outline: Float[np.ndarray, "N 2"]
    height: float

    def __post_init__(self) -> None:
        freeze_arrays(self)


@dataclass(frozen=True, slots=True, eq=False)
class Town:
    """A road network that can be driven.

    Attributes:
        name: Name of its folder in assets/towns.
        lanes: Every driving lane by name.
        lights: Every traffic light by name.
        bounds: Smallest x, smallest y, largest x, largest y of the lanes [m].
        digest: SHA-256 of the map and of town.json, hexadecimal.
        markings: Paint on the road.
        signs: Traffic signs.
        objects: Other things that the map places.
        sidewalks: Sidewalks of the map as outlines, world frame, each (N, 2) [m]; empty where the map has none.
    """

    name: str
    lanes: Mapping[str, Lane]
    lights: Mapping[str, TrafficLight]
    bounds: Float[np.ndarray, "4"]
    digest: str
    markings: tuple[Marking, ...] = ()
    signs: tuple[Sign, ...] = ()
    objects: tuple[StaticObject, ...] = ()
    sidewalks: tuple[Float[np.ndarray, "_ 2"], ...] = ()

    def __post_init__(self) -> None:
        freeze_arrays(self)


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
        freeze_arrays(self)
