"""Drives -> a Minari data set (Farama Foundation), readable with `minari.MinariDataset(folder)`.

    metadata.json            spaces, environment, number of episodes and steps
    main_data.hdf5
        episode_<i>          attributes: id, seed, total_steps, and what `Episode` says of the whole drive
            observations/bev     (T, 5, 192, 192)      what the policy saw, drawn again
            observations/state   (T, 3)
            actions              (T - 1, 2)            driven
            rewards              (T - 1,)              of the Gymnasium environment with its own weights
            terminations         (T - 1,)              false: drives go on
            truncations          (T - 1,)              true at the end
            infos/...            (T, ...)              the arrays of `Episode`

Minari wants what was seen after the last action; an episode holds what was seen before each, so the last action closes
the drive without a row of its own (`infos/actions` has it).
"""

import copy
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import gymnasium
import h5py
import numpy as np
from gymnasium import spaces

from mjdrive.bev.layers import Layer
from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode, Infraction, Town
from mjdrive.envs import registration
from mjdrive.envs.driving_env import observation_space
from mjdrive.episodes.views import states
from mjdrive.errors import DataError
from mjdrive.exchange.rewards import rewards_of
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import car_of, town_of

MAIN, METADATA = "main_data.hdf5", "metadata.json"
"""Files of a data set."""

ARRAYS = ("time", "physics", "vehicle", "actions", "labels", "on_lane")
"""Fields of `Episode` under `infos`."""

_VERSION = "0.5.4"  # of Minari, whose layout this is


def write(recordings: Sequence[Recording], folder: Path, *, on_step: Callable[[int], None]) -> None:
    """Write drives of one town as a data set.

    Raises:
        DataError: If the drives are of several towns or too short, or a town or car is not that of its episode.
    """
    names = {it.episode.town for it in recordings}
    if len(names) > 1:
        raise DataError(
            f"The drives are of {', '.join(sorted(names))}; a Minari data set has one environment. Export each town by itself."
        )
    short = [it.name for it in recordings if len(it.episode.time) < 2]
    if short:
        raise DataError(f"The drive '{short[0]}' has one step; Minari wants at least two.")
    towns = [(town_of(it.episode), car_of(it.episode, name=it.car).parameters) for it in recordings]
    views, done = ViewMaker(towns[0][0]), 0
    with h5py.File(folder / MAIN, "w", track_order=True) as file:
        for index, (it, (town, parameters)) in enumerate(zip(recordings, towns, strict=True)):
            group = file.create_group(f"episode_{index}")
            group.attrs.update(_attributes(it, index))
            group["rewards"] = rewards_of(it.episode, town, parameters)
            _put_steps(group, it.episode)
            bev = _empty_views(group, len(it.episode.time))
            for step in range(len(it.episode.time)):
                bev[step] = views.bev(it.episode, step)
                on_step(done + step + 1)
            done += len(it.episode.time)
    total = done - len(recordings)
    metadata = _metadata(towns[0][0], len(recordings), total)
    (folder / METADATA).write_text(json.dumps(metadata, indent=1) + "\n")


def _attributes(recording: Recording, index: int) -> dict[str, Any]:
    episode = recording.episode
    return {
        "id": index,
        "seed": episode.seed,
        "total_steps": len(episode.time) - 1,
        "name": recording.name,
        "town": episode.town,
        "policy": episode.policy,
        "light_phase": episode.light_phase,
        "infractions": json.dumps([_infraction(it) for it in episode.infractions]),
        "metadata": json.dumps(dict(episode.metadata), sort_keys=True),
    }


def _infraction(it: Infraction) -> dict[str, Any]:
    return {"kind": it.kind.name.lower(), "time": it.time, "x": it.x, "y": it.y, "cause": it.cause}


def _put_steps(group: h5py.Group, episode: Episode) -> None:
    last = len(episode.time) - 1
    group["actions"] = episode.actions[:-1].astype(np.float32)
    group["terminations"] = np.zeros(last, bool)
    group["truncations"] = np.arange(last) == last - 1
    group["observations/state"] = states(episode)
    for name in ARRAYS:
        group.create_dataset(f"infos/{name}", data=getattr(episode, name), compression="gzip")


def _empty_views(group: h5py.Group, count: int) -> h5py.Dataset:
    size = BevConfig().size_px
    shape = (len(Layer), size, size)
    return group.create_dataset(
        "observations/bev",
        (count, *shape),
        np.uint8,
        chunks=(1, *shape),
        compression="gzip",
    )


def _metadata(town: Town, episodes: int, steps: int) -> dict[str, Any]:
    registration.register()
    shipped = town.name in registration.TOWNS
    name = registration.id_of(town.name) if shipped else registration.ANY_TOWN
    spec = copy.deepcopy(gymnasium.spec(name))  # Gymnasium's own
    spec.kwargs["town"] = town.name
    return {
        "dataset_id": f"mjdrive/{town.name}-v0",
        "total_episodes": episodes,
        "total_steps": steps,
        "data_format": "hdf5",
        "jpeg_encoding": False,
        "observation_space": json.dumps(_space(observation_space())),
        "action_space": json.dumps(_space(spaces.Box(-1.0, 1.0, (2,), np.float32))),
        "env_spec": spec.to_json(),
        "minari_version": _VERSION,
        "description": f"Drives through {town.name} of mjdrive: bird's-eye view and state -> acceleration and steering.",
        "algorithm_name": "mjdrive",
    }


def _space(space: Any) -> dict[str, Any]:
    """A space as Minari writes it."""
    if isinstance(space, spaces.Dict):
        return {"type": "Dict", "subspaces": {name: _space(it) for name, it in space.items()}}
    return {
        "type": "Box",
        "dtype": str(space.dtype),
        "shape": list(space.shape),
        "low": space.low.tolist(),
        "high": space.high.tolist(),
    }
