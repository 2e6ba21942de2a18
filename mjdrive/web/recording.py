"""What a person drives, as demonstrations: a data set like those of `mjdrive collect`, told apart by its source."""

import dataclasses
import shutil
from itertools import chain, count
from pathlib import Path
from typing import NamedTuple

import numpy as np

from mjdrive import versions
from mjdrive.datatypes import Action, Episode, Infraction, Town, VehicleState
from mjdrive.episodes import dataset, store
from mjdrive.episodes.manifest import Manifest
from mjdrive.errors import DataError
from mjdrive.files import write_atomically
from mjdrive.simulation.simulation import Simulation
from mjdrive.vehicle.cars import CarModel

SOURCE, HUMAN = "source", "human"
"""Key and value in the metadata of an episode and the settings of its data set."""

LEAST_STEPS = 10
"""Of a drive that is worth keeping [-]."""

MOST_STEPS = 36_000
"""Of one drive; then a new one begins, so that a page left open does not fill the memory: one hour [-]."""


LEAST_FREE = 500_000_000
"""Of the disk, for somebody to begin to record [bytes]."""


class Row(NamedTuple):
    """What was true when an action was chosen, as in `Episode`."""

    time: float
    physics: np.ndarray
    vehicle: VehicleState
    on_lane: bool
    action: Action


class Recording:
    """One drive by hand, while it is driven.

    Args:
        simulation: Where it is driven.
        seed: Of the drive that it is a part of.
    """

    def __init__(self, simulation: Simulation, seed: int) -> None:
        self._simulation, self._seed = simulation, seed
        self._rows: list[Row] = []
        self._infractions: list[Infraction] = []
        self._light_phase = simulation.light_phase

    def __len__(self) -> int:
        return len(self._rows)

    def before(self, action: Action) -> None:
        """Note what is true when an action was chosen."""
        now = self._simulation
        row = Row(now.time, now.car.save(), now.vehicle, now.is_on_lane, action)
        self._rows.append(row)

    def after(self, infractions: tuple[Infraction, ...]) -> None:
        """Note what came of it."""
        self._infractions += infractions

    @property
    def is_worth_keeping(self) -> bool:
        """Whether it is more than a touch of the wheel."""
        return len(self._rows) >= LEAST_STEPS

    @property
    def is_full(self) -> bool:
        """Whether a new one should begin."""
        return len(self._rows) >= MOST_STEPS

    def episode(self) -> Episode:
        """Finish it.

        Raises:
            DataError: If hardly anything was driven.
        """
        if not self.is_worth_keeping:
            raise DataError(
                f"{len(self._rows)} steps were driven by hand; expected at least {LEAST_STEPS} to keep. Take the wheel "
                f"and drive."
            )
        actions = np.array([(it.action.acceleration, it.action.steering) for it in self._rows])
        model = self._simulation.car_model
        return Episode(
            town=self._simulation.town.name,
            policy=HUMAN,
            seed=self._seed,
            light_phase=self._light_phase,
            time=np.array([it.time for it in self._rows]),
            physics=np.array([it.physics for it in self._rows]),
            vehicle=np.array([dataclasses.astuple(it.vehicle) for it in self._rows]),
            actions=actions,
            labels=actions,
            on_lane=np.array([it.on_lane for it in self._rows]),
            infractions=tuple(self._infractions),
            metadata={
                SOURCE: HUMAN,
                "town_digest": self._simulation.town.digest,
                "car": model.name,
                "car_digest": model.digest,
                **versions.to_metadata(versions.versions()),
            },
        )


def require_room(folder: Path) -> None:
    """Refuse to record where the disk is nearly full.

    Args:
        folder: Of data sets; it need not be there yet.

    Raises:
        DataError: If less than `LEAST_FREE` is free.
    """
    there = next(it for it in (folder.absolute(), *folder.absolute().parents) if it.is_dir())
    free = shutil.disk_usage(there).free
    if free < LEAST_FREE:
        raise DataError(
            f"{free / 1e6:.0f} MB are free where '{folder}' is; expected {LEAST_FREE / 1e6:.0f} MB to record what you "
            f"drive. Make room, or start `mjdrive serve` with another --data."
        )


def keep(episode: Episode, folder: Path, *, town: Town, car: CarModel) -> Path:
    """Add a drive to a data set of drives by hand; nothing that is there is written over.

    Args:
        episode: The drive.
        folder: The data set; it is made if it is not there. Where it holds something else, such as drives of another
            version of the town, it is "<folder>-2" or the next one that does not.
        town: Where it was driven.
        car: What was driven.

    Returns:
        The file.

    Raises:
        DataError: If it cannot be written.
    """
    try:
        folder, manifest = _place(folder, town, car)
        number = next(it for it in count(len(manifest.episodes)) if not _file(folder, it).exists())
        path = _file(folder, number)
        content = store.to_bytes(episode)
        entry = dataset.describe(episode, name=path.stem, file=path.name, content=content)
        folder.mkdir(parents=True, exist_ok=True)
        write_atomically(path, content)
        entries = (*manifest.episodes, entry)
        grown = dataclasses.replace(manifest, episodes=entries, num_planned=len(entries))
        dataset.write_manifest(grown, folder)
    except OSError as error:
        raise DataError(
            f"What you drove cannot be written to '{folder}': {error.strerror or error}. It is still in memory: mend that and "
            f"keep it again, or drop it."
        ) from error
    return path


def _file(folder: Path, number: int) -> Path:
    return folder / f"human-{number:04d}.hdf5"


def _place(folder: Path, town: Town, car: CarModel) -> tuple[Path, Manifest]:
    """The first folder that is free or holds such drives, and its description."""
    others = (folder.with_name(f"{folder.name}-{number}") for number in count(2))
    places = ((place, _manifest(place, town, car)) for place in chain([folder], others))
    return next((place, found) for place, found in places if found is not None)


def _manifest(folder: Path, town: Town, car: CarModel) -> Manifest | None:
    """The description of the data set that is there, or of a new one; None if it is another kind."""
    if not (folder / dataset.MANIFEST).is_file():
        return Manifest(
            town=town.name,
            town_digest=town.digest,
            seed=0,
            settings={SOURCE: HUMAN},
            versions=versions.versions(),
            num_planned=0,
            car=car.name,
            car_digest=car.digest,
        )
    try:
        manifest = dataset.read_manifest(folder)
    except DataError:
        return None  # damaged, or of another version: nothing of ours to add to
    same = (manifest.town_digest, manifest.car_digest) == (town.digest, car.digest)
    return manifest if manifest.settings.get(SOURCE) == HUMAN and same else None
