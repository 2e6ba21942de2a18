"""The data sets of a study: what agents learn from, and the expert's walk that nobody learns from."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mjdrive.config import CollectConfig, Demonstrations, StudyConfig
from mjdrive.datatypes import Route, Town
from mjdrive.episodes import demonstrations, presets
from mjdrive.episodes.plan import lay_routes, plan
from mjdrive.execution.work import Executor
from mjdrive.study.jobs.sharing import Report
from mjdrive.study.records.folder import HELD_OUT, StudyFolder
from mjdrive.town import library


@dataclass(frozen=True, eq=False)
class Collection:
    """A data set to collect, or to go on with.

    Attributes:
        town: Where.
        routes: Routes of the town by name; none for a random walk.
        folder: Data folder.
        settings: What is driven, and how.
        seed: Decides all that is random in it.
        num_episodes: Drives in it [-].
    """

    town: Town
    routes: Mapping[str, Route]
    folder: Path
    settings: CollectConfig
    seed: int
    num_episodes: int

    def collect(self, *, executor: Executor, report: Report) -> None:
        """Drive what is missing.

        Args:
            executor: Where; the files do not depend on it.
            report: Told how far each drive is, by a name that no other data set has.

        Raises:
            DataError: If the folder holds something else.
            RouteError: If the expert cannot drive a route.
            WorkerError: If a process was lost.
        """
        name = self.folder.name
        demonstrations.collect(
            self.town,
            self.routes,
            self.folder,
            settings=self.settings,
            seed=self.seed,
            executor=executor,
            report=lambda item, done, expected: report(f"{name}, {item}", done, expected),
        )


def collections(
    config: StudyConfig, folder: StudyFolder, *, given: Mapping[str, Path]
) -> tuple[Collection, ...]:
    """Plan the data sets that a study collects itself.

    Args:
        config: Settings of the study.
        folder: Its folder.
        given: Data sets that are there already, by name.

    Raises:
        RouteError: If the town has no routes, or one that cannot be driven.
        UnknownNameError: If there is no such town, preset or route.
    """
    wanted = [
        _planned(config.learning_town, folder.data(it.name), _settings(it), config.seed)
        for it in config.demonstrations
        if it.name not in given
    ]
    if config.held_out_km:
        # Undisturbed: what is asked is how likely the expert's own driving is, not its way back from disturbances.
        walk = CollectConfig(random_walk_km=config.held_out_km, disturbance=None)
        wanted.append(_planned(config.town, folder.data(HELD_OUT), walk, config.seed + 1))
    return tuple(wanted)


def _planned(town_name: str, folder: Path, settings: CollectConfig, seed: int) -> Collection:
    town, waypoints = library.load(town_name), library.load_settings(town_name).routes
    routes = lay_routes(town, waypoints, settings=settings)
    count = len(plan(town, routes, settings=settings, seed=seed))
    return Collection(town, routes, folder, settings, seed, count)


def _settings(it: Demonstrations) -> CollectConfig:
    return presets.chosen(
        it.preset, routes=it.routes or None, random_walk_km=it.random_walk_km or None
    )
