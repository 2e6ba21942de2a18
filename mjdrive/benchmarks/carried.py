"""Demonstrations without a drive: a car is carried along random ways, a metre a step, and labelled with their bends."""

from pathlib import Path

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Episode
from mjdrive.episodes import dataset, store
from mjdrive.episodes.manifest import Manifest
from mjdrive.learning.batches import PackedDemonstrations
from mjdrive.town import library, routing
from mjdrive.versions import versions

TOWN = "town01"
WAY = 1000
"""Steps of an episode [-]."""


def demonstrations(num: int, *, seed: int = 0) -> PackedDemonstrations:
    """Draw the views of a town from many places, as training does, with plausible labels.

    Args:
        num: Number of pairs of observation and action [-].
        seed: Decides ways and labels.
    """
    return PackedDemonstrations(_episodes(num, seed), library.load(TOWN))


def write_dataset(folder: Path, num: int, *, seed: int = 0) -> None:
    """Write such demonstrations as `mjdrive collect` writes its own.

    Args:
        folder: New folder, or one of such demonstrations, which are replaced.
        num: Number of pairs of observation and action [-].
        seed: Decides ways and labels.
    """
    entries = []
    for number, episode in enumerate(_episodes(num, seed)):
        name = f"way-{number:02}"
        path = folder / f"{name}.hdf5"
        store.write(episode, path)
        content = path.read_bytes()
        entries.append(dataset.describe(episode, name=name, file=path.name, content=content))
    manifest = Manifest(
        town=TOWN,
        town_digest=library.load(TOWN).digest,
        seed=seed,
        settings={},
        versions=versions(),
        num_planned=len(entries),
        episodes=tuple(entries),
    )
    dataset.write_manifest(manifest, folder)


def _episodes(num: int, seed: int) -> list[Episode]:
    rng = np.random.default_rng(seed)
    lengths = [WAY] * (num // WAY) + [num % WAY] * (num % WAY > 0)
    return [_episode(length, rng) for length in lengths]


def _episode(num_steps: int, rng: np.random.Generator) -> Episode:
    town = library.load(TOWN)
    length = num_steps + 2.0
    lane, station = routing.random_start(town, rng, length=length)
    route = routing.random_route(town, lane=lane, station=station, length=length, rng=rng)
    vehicle = np.zeros((num_steps, 6))
    vehicle[:, :2] = route.points[:num_steps]
    vehicle[:, 2] = route.yaw[:num_steps]
    vehicle[:, 3] = rng.uniform(0, 8, num_steps)
    labels = _labels(route.curvature[:num_steps], rng)
    return Episode(
        town=town.name,
        policy="carried",
        seed=0,
        light_phase=float(rng.uniform(0, 45)),
        time=0.1 * np.arange(num_steps),
        physics=np.zeros((num_steps, 1)),
        vehicle=vehicle,
        actions=labels,
        labels=labels,
        on_lane=np.ones(num_steps, bool),
        infractions=(),
        metadata={},
    )


def _labels(
    curvature: Float[np.ndarray, " T"], rng: np.random.Generator
) -> Float[np.ndarray, "T 2"]:
    steering = np.clip(4.0 * curvature + rng.normal(0, 0.02, len(curvature)), -1, 1)
    return np.column_stack([rng.uniform(-1, 1, len(curvature)), steering])
