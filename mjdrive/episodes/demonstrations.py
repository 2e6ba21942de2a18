"""Fill a data folder: drive what is planned, keep what is finished, go on where it stopped."""

import dataclasses
import json
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from mjdrive import config, versions
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Route, Town
from mjdrive.episodes import dataset
from mjdrive.episodes.collector import Collecting, Driven
from mjdrive.episodes.manifest import Collection, EpisodeEntry, Manifest
from mjdrive.episodes.mixing import find_place
from mjdrive.episodes.plan import PlannedEpisode, plan
from mjdrive.execution.serial import SerialExecutor
from mjdrive.execution.work import Executor
from mjdrive.files import write_atomically
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel

Report = Callable[[str, int, int], None]
"""Told the name of an episode, its steps so far, and the steps expected of it; at the end both are equal."""

_INTERVAL = 0.1
"""About the time between two control steps [s]."""


def collect(
    town: Town,
    routes: Mapping[str, Route],
    folder: Path,
    *,
    settings: CollectConfig,
    seed: int,
    car: CarModel | None = None,
    executor: Executor | None = None,
    mix: bool = False,
    overwrite: bool = False,
    report: Report = lambda name, done, expected: None,
    on_late_plans: Callable[[int], None] = lambda count: None,
) -> Manifest:
    """Let an expert drive the routes of a town, or take random turns, into a folder.

    Each finished episode is kept at once, so an interrupted collection can be run again and goes on.

    Args:
        town: Town to drive in.
        routes: Its routes by name.
        folder: Data folder; it may hold a part of the same data set.
        settings: Which routes, how often, and how they are driven.
        seed: The same seed gives the same files.
        car: Which car drives; the default one if None.
        executor: Where episodes are driven; here, one after the other, if None. The files do not depend on it.
        mix: Whether to add to a data set of the same town that was collected in another way.
        overwrite: Whether to replace a data set that is there, once the first episode has been driven.
        report: Told how far the collection is.
        on_late_plans: Told of each episode how many plans of its expert came late on this machine.

    Returns:
        The description of the finished data set.

    Raises:
        ConfigError: If a random walk would be cut into pieces that are too short.
        DataError: If the folder holds something else.
        RouteError: If the town has no routes, or the expert cannot drive one.
        SolverError: If the solver of the MPC expert is missing.
        UnknownNameError: If a route is not one of the town's.
        WorkerError: If a process or machine that drove was lost, or has other versions than this one.
    """
    car = car or cars.load()
    planned = plan(town, routes, settings=settings, seed=seed)
    collection = Collection(
        seed=seed,
        settings=described(settings),
        versions=versions.versions(),
        car=car.name,
        car_digest=car.digest,
        num_planned=len(planned),
    )
    manifest, number = find_place(folder, town, collection, mix=mix, overwrite=overwrite)
    if number:
        planned = tuple(
            dataclasses.replace(episode, name=f"{episode.name}-mix{number}") for episode in planned
        )
    work = Collecting(town, routes, settings, car, collection, number, versions.all_versions())
    finished = {
        entry.name: entry
        for entry in (() if overwrite else manifest.episodes)
        if entry.collection == number and dataset.is_intact(folder, entry)
    }
    for entry in finished.values():
        report(entry.name, entry.steps, entry.steps)
    missing = [episode for episode in planned if episode.name not in finished]
    if not missing:
        return manifest
    with closing(_driven(work, missing, executor or SerialExecutor(), report)) as driven:
        is_described = False
        for entry, content, late_plans in driven:
            if not is_described:
                if overwrite:
                    dataset.remove(folder)
                # On disk first, so that a folder with an episode in it always says what it is.
                manifest = _keep(manifest, number, planned, finished, folder)
                is_described = True
            write_atomically(folder / entry.file, content)
            finished[entry.name] = entry
            manifest = _keep(manifest, number, planned, finished, folder)
            report(entry.name, entry.steps, entry.steps)
            on_late_plans(late_plans)
    return manifest


def described(settings: CollectConfig) -> dict[str, Any]:
    """Settings of a collection as JSON values, without those of an expert that has no part in it."""
    values: dict[str, Any] = json.loads(config.to_json(settings))
    if settings.expert == "pid":
        del values["mpc"]
    return values


def _driven(
    work: Collecting, episodes: Sequence[PlannedEpisode], executor: Executor, report: Report
) -> Generator[Driven]:
    """Check all that can be checked at once; the episodes are driven as they are asked for."""
    work.collector.require_drivable(episodes)
    if not isinstance(executor, SerialExecutor):
        # Long ones first, so that nobody is left with one when the others are done.
        episodes = sorted(episodes, key=lambda episode: episode.length, reverse=True)

    def on_progress(episode: PlannedEpisode, done: int) -> None:
        # About half of the time is spent at lights and in turns.
        expected = round(1.5 * episode.length / work.settings.pid.target_speed / _INTERVAL)
        # A drive that takes longer than expected is always one step from its end.
        report(episode.name, done, max(expected, done + 1))

    with closing(executor.run(work, episodes, on_progress=on_progress)) as results:
        for _, driven in results:
            yield driven


def _keep(
    manifest: Manifest,
    number: int,
    planned: Sequence[PlannedEpisode],
    finished: Mapping[str, EpisodeEntry],
    folder: Path,
) -> Manifest:
    """List what is finished of a collection, in the order of its plan, between the others, and write that down."""
    entries = (
        *(entry for entry in manifest.episodes if entry.collection < number),
        *(finished[episode.name] for episode in planned if episode.name in finished),
        *(entry for entry in manifest.episodes if entry.collection > number),
    )
    manifest = dataclasses.replace(manifest, episodes=entries)
    dataset.write_manifest(manifest, folder)
    return manifest
