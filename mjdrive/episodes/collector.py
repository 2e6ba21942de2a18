"""Drives the planned episodes of a collection, one after the other, and gives each as the bytes of its file."""

import dataclasses
import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from mjdrive import versions
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Episode, Route, Town
from mjdrive.episodes import dataset, store
from mjdrive.episodes.collection import (
    begin_walk,
    collect_route,
    collect_walk,
    expert_of,
    place_at_start,
)
from mjdrive.episodes.manifest import Collection, EpisodeEntry
from mjdrive.episodes.plan import PlannedEpisode
from mjdrive.expert.reference import require_green, stop_lines
from mjdrive.expert.solves import SolveWatch
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel


class Driven(NamedTuple):
    """An episode that was driven.

    Attributes:
        entry: Its entry in the manifest.
        content: Its file, byte for byte.
        late_plans: Plans of the expert that came late on this machine [-].
    """

    entry: EpisodeEntry
    content: bytes
    late_plans: int


@dataclass(frozen=True, eq=False)
class Collecting:
    """All that a process has to know to drive the episodes of a collection, wherever it runs.

    Attributes:
        town: Where to drive.
        routes: Its routes by name.
        settings: Expert, disturbance and how far.
        car: Which car drives.
        collection: The description of the collection.
        number: Number of the collection in its data set [-].
        versions: Of the software where the collection was asked for.
    """

    town: Town
    routes: Mapping[str, Route]
    settings: CollectConfig
    car: CarModel
    collection: Collection
    number: int
    versions: Mapping[str, str]

    def begin(self) -> Callable[[PlannedEpisode, Callable[[int], None]], Driven]:
        """Build the simulation and the expert; what comes back drives one episode.

        Raises:
            SolverError: If the solver of the MPC expert is missing.
            WorkerError: If this is a machine with other versions than where the collection was asked for, or with
                another car or town of that name.
        """
        versions.require_same(self.versions)
        library.require_same(self.town)
        cars.require_same(self.car)
        return self.collector.drive

    @cached_property
    def collector(self) -> "Collector":
        """The simulation and the expert of this process."""
        return Collector(self)

    def __getstate__(self) -> dict[str, Any]:
        """Other processes build a simulation of their own."""
        return {name: value for name, value in vars(self).items() if name != "collector"}


class Collector:
    """A simulation and an expert, ready to drive.

    Args:
        work: What to drive.

    Raises:
        SolverError: If the solver of the MPC expert is missing.
    """

    def __init__(self, work: Collecting) -> None:
        self._work = work
        self._simulation = Simulation(work.town, car=work.car)
        self._expert = expert_of(work.settings, self._simulation)

    def require_drivable(self, episodes: Iterable[PlannedEpisode]) -> None:
        """Refuse what can be seen to go wrong, before anything is driven.

        Args:
            episodes: What will be driven.

        Raises:
            RouteError: If something stands at a start, the lanes end too soon, or a light on the way never turns green.
        """
        town = self._work.town
        for episode in episodes:
            if episode.route:
                route = self._work.routes[episode.route]
                require_green(town.lights[stop.light] for stop in stop_lines(town, route))
            else:
                route = begin_walk(town, length=episode.length, seed=episode.seed).route
                require_green(town.lights.values())
            place_at_start(self._simulation, route, seed=episode.seed)

    def drive(self, episode: PlannedEpisode, on_step: Callable[[int], None]) -> Driven:
        """Drive one episode.

        Args:
            episode: What to drive.
            on_step: Told the number of control steps done.

        Raises:
            RouteError: If the expert does not arrive.
        """
        solves = SolveWatch(self._expert)
        if episode.route:
            driven = collect_route(
                self._simulation,
                self._work.routes[episode.route],
                config=self._work.settings,
                seed=episode.seed,
                expert=self._expert,
                on_step=on_step,
            )
        else:
            driven = collect_walk(
                self._simulation,
                length=episode.length,
                config=self._work.settings,
                seed=episode.seed,
                expert=self._expert,
                on_step=on_step,
            )
        described = self._described(driven)
        content = store.to_bytes(described)
        entry = dataset.describe(
            described,
            name=episode.name,
            file=f"{episode.name}.hdf5",
            content=content,
            collection=self._work.number,
        )
        return Driven(entry, content, solves.late)

    def _described(self, episode: Episode) -> Episode:
        """Give an episode the description of the collection that it belongs to."""
        collection = self._work.collection
        metadata = {
            **episode.metadata,
            "town_digest": self._work.town.digest,
            "car": collection.car,
            "car_digest": collection.car_digest,
            "settings": json.dumps(collection.settings, sort_keys=True),
            **versions.to_metadata(collection.versions),
        }
        return dataclasses.replace(episode, metadata=metadata)
