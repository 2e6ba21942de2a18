"""Drives the planned episodes of a collection, one after the other, and gives each as the bytes of its file."""

import dataclasses
import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

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
from mjdrive.vehicle.cars import CarModel


class Driven(NamedTuple):
    """An episode that was driven.

    Attributes:
        entry: Its entry in the manifest.
        content: Its file, byte for byte.
        late_solves: Solves of the expert that took long on this machine [-].
    """

    entry: EpisodeEntry
    content: bytes
    late_solves: int


@dataclass(frozen=True, slots=True, eq=False)
class Job:
    """All that a process has to know to drive the episodes of a collection.

    Attributes:
        town: Where to drive.
        routes: Its routes by name.
        settings: Expert, disturbance and how far.
        car: Which car drives.
        collection: The description of the collection.
        number: Number of the collection in its data set [-].
    """

    town: Town
    routes: Mapping[str, Route]
    settings: CollectConfig
    car: CarModel
    collection: Collection
    number: int


class Collector:
    """A simulation and an expert, ready to drive.

    Args:
        job: What to drive.

    Raises:
        SolverError: If the solver of the MPC expert is missing.
    """

    def __init__(self, job: Job) -> None:
        self._job = job
        self._simulation = Simulation(job.town, car=job.car)
        self._expert = expert_of(job.settings, self._simulation)

    def require_drivable(self, episodes: Iterable[PlannedEpisode]) -> None:
        """Refuse what can be seen to go wrong, before anything is driven.

        Args:
            episodes: What will be driven.

        Raises:
            RouteError: If something stands at a start, the lanes end too soon, or a light on the way never turns green.
        """
        town = self._job.town
        for episode in episodes:
            if episode.route:
                route = self._job.routes[episode.route]
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
                self._job.routes[episode.route],
                config=self._job.settings,
                seed=episode.seed,
                expert=self._expert,
                on_step=on_step,
            )
        else:
            driven = collect_walk(
                self._simulation,
                length=episode.length,
                config=self._job.settings,
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
            collection=self._job.number,
        )
        return Driven(entry, content, solves.late)

    def _described(self, episode: Episode) -> Episode:
        """Give an episode the description of the collection that it belongs to."""
        collection = self._job.collection
        metadata = {
            **episode.metadata,
            "town_digest": self._job.town.digest,
            "car": collection.car,
            "car_digest": collection.car_digest,
            "settings": json.dumps(collection.settings, sort_keys=True),
            **versions.to_metadata(collection.versions),
        }
        return dataclasses.replace(episode, metadata=metadata)
