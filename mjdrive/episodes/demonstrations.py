"""Fill a data folder: drive every route of a town, keep what is finished, go on where it stopped."""

import dataclasses
import json
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from mjdrive import config, versions
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Episode, Route, Town
from mjdrive.episodes import dataset, store
from mjdrive.episodes.collection import collect_route
from mjdrive.episodes.dataset import EpisodeEntry, Manifest
from mjdrive.errors import DataError, RouteError, UnknownNameError
from mjdrive.files import write_atomically
from mjdrive.simulation.simulation import Simulation
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel

Report = Callable[[str, int, int], None]
"""Told the name of an episode, its steps so far, and the steps expected of it; at the end both are equal."""


def collect(
    town: Town,
    routes: dict[str, Route],
    folder: Path,
    *,
    settings: CollectConfig,
    seed: int,
    car: CarModel | None = None,
    report: Report = lambda name, done, expected: None,
) -> Manifest:
    """Let the expert drive the routes of a town into a folder.

    Each finished episode is kept at once, so an interrupted collection can be run again and goes on.

    Args:
        town: Town to drive in.
        routes: Its routes by name.
        folder: Data folder; it may hold a part of the same data set.
        settings: Which routes, how often, and how they are driven.
        seed: The same seed gives the same files.
        car: Which car drives; the default one if None.
        report: Told how far the collection is.

    Returns:
        The description of the finished data set.

    Raises:
        DataError: If the folder holds something else.
        RouteError: If the town has no routes.
        UnknownNameError: If a route is not one of the town's.
    """
    if not routes:
        raise RouteError(
            f"Town '{town.name}' has no routes. Expected routes in its town.json; town01 has ten."
        )
    names = settings.routes or tuple(routes)
    for name in names:
        if name not in routes:
            raise UnknownNameError(f"route of {town.name}", name, routes)
    plan = _plan(names, settings.repeats)
    car = car or cars.load()
    manifest = Manifest(
        town=town.name,
        town_digest=town.digest,
        car=car.name,
        car_digest=car.digest,
        seed=seed,
        settings=json.loads(config.to_json(settings)),
        versions=versions.versions(),
        num_planned=len(plan),
    )
    finished = _finished(folder, manifest)
    simulation = Simulation(town, car=car)
    for index, (name, route_name) in enumerate(plan.items()):
        route = routes[route_name]
        if name not in finished:
            # On disk first, so that a folder with an episode in it always says what it is.
            dataset.write_manifest(_with_episodes(manifest, finished, plan), folder)
            expected = _expected_steps(route, simulation, settings)
            episode = collect_route(
                simulation,
                route,
                config=settings,
                seed=episode_seed(seed, index),
                on_step=_reporter(report, name, expected),
            )
            finished[name] = _keep(_described(episode, town, manifest), folder, name=name)
        report(name, finished[name].steps, finished[name].steps)
    manifest = _with_episodes(manifest, finished, plan)
    dataset.write_manifest(manifest, folder)
    return manifest


def _plan(routes: tuple[str, ...], repeats: int) -> dict[str, str]:
    """Name every episode of a collection, in the order of driving, and say which route it drives."""
    return {f"{route}-{repeat}": route for repeat in range(repeats) for route in routes}


def _with_episodes(
    manifest: Manifest, finished: Mapping[str, EpisodeEntry], plan: Mapping[str, str]
) -> Manifest:
    """List what is finished, in the order of the plan."""
    entries = tuple(finished[name] for name in plan if name in finished)
    return dataclasses.replace(manifest, episodes=entries)


def _reporter(report: Report, name: str, expected: int) -> Callable[[int], None]:
    """Report the steps of one episode; a drive longer than expected is always one step from its end."""
    return lambda done: report(name, done, max(expected, done + 1))


def episode_seed(seed: int, index: int) -> int:
    """Seed of one episode of a collection, unlike those of all others and of neighbouring collections."""
    return int(np.random.SeedSequence([seed, index]).generate_state(1)[0])


def _finished(folder: Path, wanted: Manifest) -> dict[str, EpisodeEntry]:
    """The intact episodes of an earlier run of the same collection, by name.

    Raises:
        DataError: If the folder holds something else.
    """
    if not (folder / dataset.MANIFEST).exists() and not any(folder.glob("*.hdf5")):
        return {}
    found = dataset.read_manifest(folder)
    names = [field.name for field in dataclasses.fields(Manifest) if field.name != "episodes"]
    other = [name for name in names if getattr(found, name) != getattr(wanted, name)]
    if other:
        raise DataError(
            f"'{folder}' holds a data set that differs in {', '.join(other)}. Expected a new folder or the same "
            f"collection. Give another folder with --out, or replace it with --overwrite."
        )
    return {entry.name: entry for entry in found.episodes if dataset.is_intact(folder, entry)}


def _described(episode: Episode, town: Town, manifest: Manifest) -> Episode:
    """Give an episode the description of the collection that it belongs to."""
    metadata = {
        **episode.metadata,
        "town_digest": town.digest,
        "car": manifest.car,
        "car_digest": manifest.car_digest,
        "settings": json.dumps(manifest.settings, sort_keys=True),
        **versions.to_metadata(manifest.versions),
    }
    return dataclasses.replace(episode, metadata=metadata)


def _keep(episode: Episode, folder: Path, *, name: str) -> EpisodeEntry:
    """Write one finished episode and describe it."""
    content = store.to_bytes(episode)
    write_atomically(folder / f"{name}.hdf5", content)
    return dataset.describe(episode, name=name, file=f"{name}.hdf5", content=content)


def _expected_steps(route: Route, simulation: Simulation, settings: CollectConfig) -> int:
    """About how many steps a route takes, half of the time at lights and in turns [-]."""
    duration = 1.5 * float(route.station[-1]) / settings.pid.target_speed
    return round(duration / simulation.config.control_interval)
