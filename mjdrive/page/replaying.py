"""Episode -> one message with all that the page needs to replay it.

rows         as in "history"
poses        position [m] and quaternion of each body of the car at each step, (T, N, 7)
lights       signal of each light at each step, (T, L) uint8
infractions  in the head: kind, time [s], x, y [m], cause
"""

from functools import lru_cache

import mujoco
import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Episode, Town
from mjdrive.errors import DataError
from mjdrive.page import wire
from mjdrive.recording.playback import CAR, car_of, town_of
from mjdrive.town import signals
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_on_road
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.cars import CarModel

TIMESTEP = 0.005
"""Of a model that only stands where it is told [s]."""


def episode_message(episode: Episode, name: str, *, car: CarModel | None = None) -> bytes:
    """Tell a whole drive.

    Args:
        episode: The drive.
        name: How the page calls it.
        car: The car that drove; what the episode says if None.

    Raises:
        DataError: If another car drove than one that comes with mjdrive and none is given, or car or town have changed since.
        UnknownNameError: If there is no such town.
    """
    if car is None and episode.metadata.get(CAR, cars.DEFAULT) not in cars.SHIPPED:
        raise DataError(
            f"The car '{episode.metadata[CAR]}' drove this episode; the page replays those that come with mjdrive: "
            f"{', '.join(cars.SHIPPED)}. `mjdrive export --to html --car FILE.xml` shows it in a page of its own."
        )
    lights = light_signals(episode, town_of(episode))
    rows = np.column_stack(
        [episode.time, episode.vehicle[:, :2], episode.vehicle[:, 3], episode.actions]
    )
    head = {
        "name": name,
        "town": episode.town,
        "policy": episode.policy,
        "seed": episode.seed,
        "source": episode.metadata.get("source", "drive"),
        "infractions": [
            [it.kind.name.lower(), round(it.time, 1), round(it.x, 1), round(it.y, 1), it.cause]
            for it in episode.infractions
        ],
    }
    blobs = {
        "rows": rows.astype(np.float32),
        "poses": body_poses(episode, car or car_of(episode)),
        "lights": lights,
    }
    return wire.pack("episode", head, blobs)


def light_signals(episode: Episode, town: Town) -> UInt8[np.ndarray, "T L"]:
    """What each light of the town showed at each step, as a `Signal`."""
    shown = (signals.all_at(town, float(now) + episode.light_phase) for now in episode.time)
    rows = np.array([[now[name] for name in town.lights] for now in shown], np.uint8)
    return rows.reshape(len(episode.time), len(town.lights))


def body_poses(episode: Episode, driven: CarModel) -> Float[np.ndarray, "T N 7"]:
    """Where each body of the car was at each step: position [m] and quaternion, in single precision."""
    model = car_on_road(timestep=TIMESTEP, car=driven.path).compile()
    data = mujoco.MjData(model)
    car = Car(model, data)
    poses = np.empty((len(episode.time), model.nbody - 1, 7), np.float32)
    for step, physics in enumerate(episode.physics):
        car.restore(physics)
        poses[step, :, :3], poses[step, :, 3:] = data.xpos[1:], data.xquat[1:]
    return poses


def view_at(episode: Episode, step: int) -> UInt8[np.ndarray, "5 S S"]:
    """The bird's-eye view at a step.

    Raises:
        DataError: If the town has changed since.
        UnknownNameError: If there is no such town.
    """
    return _projector(town_of(episode)).replay(episode, step)


@lru_cache(maxsize=2)
def _projector(town: Town) -> BevProjector:
    return BevProjector(town)
