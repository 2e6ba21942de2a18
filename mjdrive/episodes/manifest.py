"""What a data set says about itself."""

from dataclasses import dataclass, field
from typing import Any

from mjdrive.vehicle import cars

FORMAT = "mjdrive-dataset-1"


@dataclass(frozen=True, slots=True)
class EpisodeEntry:
    """One episode of a data set.

    Attributes:
        name: What was driven, unique in the data set.
        file: Name of the episode file in the folder.
        sha256: Digest of the file, hexadecimal.
        steps: Control steps in the episode [-].
        infractions: How often each kind of infraction happened; kinds that did not are left out.
        deviations: How often a disturbance pushed the car off its route [-].
        recovered: How often it found back [-].
        collection: The collection that it belongs to, as a number in `Manifest.collections` [-].
        solver: Name of the solver that the expert used; empty for one that solves nothing.
        solves: How often its solves ended in which way, see `mjdrive.expert.solves.OUTCOMES` [-].
    """

    name: str
    file: str
    sha256: str
    steps: int
    infractions: dict[str, int]
    deviations: int = 0
    recovered: int = 0
    collection: int = 0
    solver: str = ""
    solves: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Collection:
    """Episodes that one command drives, all in the same way.

    Attributes:
        seed: Seed of the collection [-].
        settings: Its settings, as JSON values.
        versions: Versions of the software that drove.
        car: Name of the car that drove.
        car_digest: Digest of its MJCF.
        num_planned: Episodes in the whole collection [-].
    """

    seed: int
    settings: dict[str, Any]
    versions: dict[str, str]
    car: str
    car_digest: str
    num_planned: int


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a data set is made from and consists of: one collection, and those that were mixed in later.

    Attributes:
        town: Name of the town.
        town_digest: Digest of the town that was driven.
        seed: Seed of the first collection [-].
        settings: Its settings, as JSON values.
        versions: Versions of the software that drove.
        car: Name of the car that drove; data sets from before one could choose were driven with the default car.
        car_digest: Digest of its MJCF.
        num_planned: Episodes in the whole of it; more than are listed while it is being collected [-].
        episodes: Finished episodes of all collections, in the order of these and of their plans.
        added: Other collections in the same folder.
        format: Version of this description.
    """

    town: str
    town_digest: str
    seed: int
    settings: dict[str, Any]
    versions: dict[str, str]
    num_planned: int
    episodes: tuple[EpisodeEntry, ...] = ()
    car: str = cars.DEFAULT
    car_digest: str = ""
    added: tuple[Collection, ...] = ()
    format: str = FORMAT

    @property
    def collections(self) -> tuple[Collection, ...]:
        """All collections of the data set, the first included."""
        first = Collection(
            seed=self.seed,
            settings=self.settings,
            versions=self.versions,
            car=self.car,
            car_digest=self.car_digest,
            num_planned=self.num_planned,
        )
        return (first, *self.added)

    @property
    def all_planned(self) -> int:
        """Episodes of all collections; more than are listed while one is being collected [-]."""
        return sum(collection.num_planned for collection in self.collections)
