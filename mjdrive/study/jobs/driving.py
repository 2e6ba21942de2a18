"""Make the drives of a study: all that are missing, whoever drives, on as many processes as one likes."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

from mjdrive import config, versions
from mjdrive.datatypes import Town
from mjdrive.episodes import store
from mjdrive.execution.work import Executor, Tell
from mjdrive.files import write_atomically
from mjdrive.simulation.simulation import Simulation
from mjdrive.study.jobs import drivers
from mjdrive.study.jobs.drivers import Who
from mjdrive.study.jobs.sharing import Report, do_all
from mjdrive.study.records import folder
from mjdrive.study.records.drive_records import DriveRecord, record
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel


@dataclass(frozen=True, slots=True)
class DriveJob:
    """One drive to make.

    Attributes:
        who: Who drives.
        file: Where it goes, without the ending.
        seed: Decides start, lights and the driver's own chance.
        num_steps: Control steps [-].
        path_of: Arm and training seed if the path is to be kept.
    """

    who: Who
    file: Path
    seed: int
    num_steps: int
    path_of: tuple[str, int] | None = None

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.who.name}, {self.file.name}"


class Driven(NamedTuple):
    """A drive that was made.

    Attributes:
        episode: Its file, byte for byte.
        record: What is counted of it.
    """

    episode: bytes
    record: DriveRecord


@dataclass(frozen=True, eq=False)
class Place:
    """Where a study drives: all that a process has to know to build its simulation.

    Attributes:
        town: The town.
        car: The car.
        versions: Of the software where the study was asked for.
    """

    town: Town
    car: CarModel
    versions: Mapping[str, str]

    def simulation(self) -> Simulation:
        """Build it.

        Raises:
            WorkerError: If versions, town or car are others than where the study was asked for.
        """
        versions.require_same(self.versions)
        library.require_same(self.town)
        cars.require_same(self.car)
        return Simulation(self.town, car=self.car)


@dataclass(frozen=True, eq=False)
class StudyDriving:
    """Makes drives in a place."""

    place: Place

    def begin(self) -> Callable[[DriveJob, Tell], Driven]:
        """Build the simulation; what comes back makes one drive."""
        return partial(_drive, self.place.simulation())


def drive_all(
    place: Place, jobs: Sequence[DriveJob], *, executor: Executor, report: Report
) -> None:
    """Make the drives that are missing.

    Args:
        place: Where.
        jobs: The drives; each gets an episode file and, last, a record.
        executor: Where the work is done; the files do not depend on it.
        report: Told how far each drive is.

    Raises:
        RunError: If the run of an agent cannot be loaded.
        WorkerError: If a process was lost.
    """

    def keep(job: DriveJob, driven: Driven) -> None:
        write_atomically(_episode_file(job), driven.episode)
        config.write_json(driven.record, _record_file(job))

    do_all(
        StudyDriving(place),
        # The longest first; else in order, one network at a time.
        sorted(jobs, key=lambda job: -job.num_steps),
        size=lambda job: job.num_steps,
        is_done=lambda job: read_record(job) is not None,
        keep=keep,
        executor=executor,
        report=report,
    )


def read_record(job: DriveJob) -> DriveRecord | None:
    """What was counted of a drive; None if it is still to be made, or was made with other weights."""
    found = folder.read(DriveRecord, _record_file(job))
    is_whole = found is not None and found.digest == job.who.digest and _episode_file(job).is_file()
    return found if is_whole else None


def _drive(simulation: Simulation, job: DriveJob, tell: Tell) -> Driven:
    episode = drivers.drive(
        job.who, simulation, num_steps=job.num_steps, seed=job.seed, on_step=tell
    )
    town = simulation.town
    counted = record(episode, town, digest=job.who.digest, path_of=job.path_of)
    return Driven(store.to_bytes(episode), counted)


def _episode_file(job: DriveJob) -> Path:
    return job.file.with_name(f"{job.file.name}.hdf5")


def _record_file(job: DriveJob) -> Path:
    return job.file.with_name(f"{job.file.name}.json")
