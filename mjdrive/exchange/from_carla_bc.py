"""Demonstrations as carla-bc records them -> episodes, where they say where the car was.

Its `data_collect.py` leaves route_<i>/ep_<i>/ with pictures and `episode.json`: columns of one value a step, as pandas writes
them. The columns that it has by itself (done, actions, state, and some more by version) say neither where the car was, nor
when in the cycle of the lights, so such files are refused: nothing is invented here. Whoever adds these columns can have
the episodes taken over; the pictures are never looked at.

town                 CARLA's name of the map, as Town01
x, y                 [m]   location of the vehicle, which CARLA puts in the middle of the car; y south
yaw                  [deg] clockwise, as CARLA has it
time                 [s]   into the cycle of the lights, as `signals.at` runs them
actions              throttle and steering, or either and a brake: (T, 2) with what brakes below 0, or (T, 3); right is positive
speed, if there      [m/s] else what the places and times come to
"""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Episode
from mjdrive.errors import DataError
from mjdrive.exchange.sources import Recording
from mjdrive.vehicle.parameters import VehicleParameters

FILE = "episode.json"

NEEDED = {
    "town": "town",
    "x": "position x",
    "y": "position y",
    "yaw": "heading yaw",
    "time": "time into the light cycle",
    "actions": "actions",
}
"""Columns without which an episode is none of ours, and what they are."""

Columns = dict[str, np.ndarray]


def read(folder: Path) -> list[Recording]:
    """Read all episodes of a folder.

    Raises:
        DataError: If there is none, a file is damaged, or one does not say where the car was and when.
    """
    found = sorted(folder.glob(f"route_*/ep_*/{FILE}"))
    if not found:
        raise DataError(
            f"'{folder}' holds no demonstrations of carla-bc; expected route_<number>/ep_<number>/{FILE} in it."
        )
    recordings = []
    for path in found:
        columns = _columns(path)
        _require_columns(columns, folder, len(found))
        try:
            episode = _episode(columns)
        except (ValueError, TypeError) as error:
            raise DataError(
                f"'{path}' is no whole episode of carla-bc: {error}. Record it again."
            ) from error
        recordings.append(Recording(f"{path.parent.parent.name}_{path.parent.name}", episode))
    return recordings


def _columns(path: Path) -> dict[str, Any]:
    try:
        columns = json.loads(path.read_text())
    except ValueError as error:
        raise DataError(f"'{path}' is no JSON file: {error}. Fetch it again.") from error
    if not isinstance(columns, dict):
        raise DataError(
            f"'{path}' holds a {type(columns).__name__}; expected columns by name, as pandas writes them. Fetch it again."
        )
    return columns


def _require_columns(columns: dict[str, Any], folder: Path, count: int) -> None:
    missing = [words for name, words in NEEDED.items() if name not in columns]
    if missing:
        raise DataError(
            f"'{folder}' holds {count} episodes of carla-bc with the columns {', '.join(columns)}, and pictures. They lack "
            f"{', '.join(missing)}, so they cannot be taken over: our views are drawn again from where the car was. Record the "
            f"columns {', '.join(NEEDED)} in CARLA (docs/recordings.md), or collect anew: `mjdrive collect --town town01`."
        )


def _episode(columns: dict[str, Any]) -> Episode:
    """Turn columns into an episode: right-handed axes, the rear axle, radians, seconds since the start."""
    rows = {name: _rows(column) for name, column in columns.items() if name in (*NEEDED, "speed")}
    lengths = {name: len(column) for name, column in rows.items()}
    steps = lengths["time"]
    if len(set(lengths.values())) != 1 or steps < 2:
        raise ValueError(f"expected at least two steps, as many in each column, found {lengths}")
    (town, *others) = set(rows.pop("town"))
    if others:
        raise ValueError(f"expected one town, found {town}, {', '.join(others)}")
    numbers = {name: np.array(column, float) for name, column in rows.items()}
    clock = numbers["time"]
    if any(column.ndim != 1 for name, column in numbers.items() if name != "actions"):
        raise ValueError("expected one number a step in every column but the actions")
    if any(not np.isfinite(column).all() for column in numbers.values()):
        raise ValueError("some values are no finite numbers")
    if np.diff(clock).min() <= 0:
        raise ValueError("its times do not grow")
    actions = _actions(numbers["actions"])
    return Episode(
        town=str(town).lower(),
        policy="carla-bc",
        seed=0,
        light_phase=float(clock[0]),
        time=clock - clock[0],
        physics=np.zeros((steps, 0)),
        vehicle=_vehicle(numbers, actions),
        actions=actions,
        labels=actions,
        on_lane=np.ones(steps, bool),
        infractions=(),
        metadata={},
    )


def _rows(column: dict[str, Any]) -> list[Any]:
    """Values of a column in the order of the steps; pandas writes their numbers as words."""
    return [column[step] for step in sorted(column, key=int)]


def _actions(pedals: Float[np.ndarray, "T A"]) -> Float[np.ndarray, "T 2"]:
    """Throttle less brake, and steering to the left, each in [-1, 1] [-]."""
    if pedals.ndim != 2 or pedals.shape[1] not in (2, 3) or np.abs(pedals).max() > 1.0:
        raise ValueError(
            f"expected actions of shape (T, 2) or (T, 3) in [-1, 1], found {pedals.shape} up to {np.abs(pedals).max():g}"
        )
    acceleration = pedals[:, 0] - (pedals[:, 2] if pedals.shape[1] == 3 else 0.0)
    return np.column_stack([acceleration, -pedals[:, 1]])


def _vehicle(numbers: Columns, actions: Float[np.ndarray, "T 2"]) -> Float[np.ndarray, "T 6"]:
    """`Episode.vehicle`; what is not recorded is what the recorded values come to."""
    parameters = VehicleParameters.default()
    turned = -np.unwrap(np.radians(numbers["yaw"]))  # CARLA's axes are left-handed
    heading = np.column_stack([np.cos(turned), np.sin(turned)])
    middle = np.column_stack([numbers["x"], -numbers["y"]])
    rear_axle = middle - (parameters.length / 2 - parameters.rear_overhang) * heading
    velocity = np.gradient(rear_axle, numbers["time"], axis=0)
    speed = numbers.get("speed", np.sum(velocity * heading, axis=1))
    yaw = math.pi - np.mod(math.pi - turned, 2 * math.pi)  # in (-pi, pi]
    yaw_rate = np.gradient(turned, numbers["time"])
    steering_angle = parameters.max_steering_angle * actions[:, 1]
    return np.column_stack([rear_axle, yaw, speed, yaw_rate, steering_angle])
