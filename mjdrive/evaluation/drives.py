"""Many drives of one policy: each in a folder of its own, kept as it comes, so that a run can be started again and goes on."""

import json
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple, Protocol, runtime_checkable

from mjdrive import config, versions
from mjdrive.datatypes import Episode, Town
from mjdrive.episodes import store
from mjdrive.episodes.plan import episode_seed
from mjdrive.errors import ConfigError, DataError
from mjdrive.evaluation import report
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.execution.work import Executor, Tell
from mjdrive.files import write_atomically
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel

DESCRIPTION = "drives.json"
"""What all drives of a folder have in common: text by name."""


@dataclass(frozen=True, slots=True)
class PlannedDrive:
    """One drive that is to be made.

    Attributes:
        name: Of its folder.
        seed: Decides all that is random in it.
    """

    name: str
    seed: int


def plan_drives(count: int, *, seed: int) -> tuple[PlannedDrive, ...]:
    """Name drives and give each a seed of its own; fewer drives are the first of more.

    Args:
        count: How many [-].
        seed: The same seed gives the same drives.
    """
    return tuple(
        PlannedDrive(f"episode-{index:03d}", episode_seed(seed, index)) for index in range(count)
    )


@runtime_checkable
class Drives(Protocol):
    """Somebody who drives freely."""

    def drive(
        self,
        simulation: Simulation,
        *,
        num_steps: int,
        seed: int,
        on_step: Tell,
        on_late_plans: Callable[[int], None] | None = None,
    ) -> Episode:
        """Drive from a random place."""


class Driven(NamedTuple):
    """A drive that was made.

    Attributes:
        files: Content of the files of its folder by name.
        late_plans: Plans of an expert that came late where it was made [-].
    """

    files: Mapping[str, bytes]
    late_plans: int


@dataclass(frozen=True, eq=False)
class Driving:
    """All that a process has to know to make drives, wherever it runs.

    Attributes:
        driver: Who drives.
        town: Where.
        car: Which car.
        num_steps: Control steps of each drive [-].
        versions: Of the software where the drives were asked for.
    """

    driver: Drives
    town: Town
    car: CarModel
    num_steps: int
    versions: Mapping[str, str]

    def begin(self) -> Callable[[PlannedDrive, Tell], Driven]:
        """Build the simulation; what comes back makes one drive.

        Raises:
            WorkerError: If this is a machine with other versions than where the drives were asked for, or with another
                car or town of that name.
        """
        versions.require_same(self.versions)
        library.require_same(self.town)
        cars.require_same(self.car)
        return partial(self._drive, Simulation(self.town, car=self.car))

    def _drive(self, simulation: Simulation, planned: PlannedDrive, tell: Tell) -> Driven:
        late_plans: list[int] = []
        episode = self.driver.drive(
            simulation,
            num_steps=self.num_steps,
            seed=planned.seed,
            on_step=tell,
            on_late_plans=late_plans.append,
        )
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place, planned.name)
            report.write_drive(episode, self.town, folder)
            files = {path.name: path.read_bytes() for path in sorted(folder.iterdir())}
        return Driven(files, sum(late_plans))


def make_drives(
    work: Driving,
    planned: Sequence[PlannedDrive],
    folder: Path,
    *,
    description: Mapping[str, str],
    executor: Executor,
    report_progress: Callable[[str, int, int], None] = lambda name, done, expected: None,
    on_late_plans: Callable[[int], None] = lambda count: None,
) -> list[DriveSummary]:
    """Make the drives that are missing in a folder.

    Args:
        work: Who drives where.
        planned: The drives.
        folder: Gets a folder for each drive; it may hold some of the same drives already.
        description: What the drives have in common; drives of another description are refused.
        executor: Where the drives are made; the files do not depend on it.
        report_progress: Told name, steps done and steps in all of a drive.
        on_late_plans: Told of each drive how many plans of an expert came late on this machine.

    Returns:
        The figures of each drive, as planned.

    Raises:
        DataError: If the folder holds something else.
        WorkerError: If a process or machine that drove was lost, or has other versions than this one.
    """
    require_same_drives(folder, description)
    finished = {}
    for drive in planned:
        summary = _finished(folder / drive.name)
        if summary is not None:
            finished[drive.name] = summary
            report_progress(drive.name, work.num_steps, work.num_steps)
    missing = [drive for drive in planned if drive.name not in finished]
    if not missing:
        return [finished[drive.name] for drive in planned]

    def on_progress(drive: PlannedDrive, done: int) -> None:
        report_progress(drive.name, min(done, work.num_steps - 1), work.num_steps)

    with closing(executor.run(work, missing, on_progress=on_progress)) as results:
        for drive, driven in results:
            # First, so that a folder with a drive in it always says what it is.
            write_atomically(folder / DESCRIPTION, _as_json(description))
            _keep(driven.files, folder / drive.name)
            summary = _finished(folder / drive.name)
            assert summary is not None, "a drive was kept without its figures"
            finished[drive.name] = summary
            report_progress(drive.name, work.num_steps, work.num_steps)
            on_late_plans(driven.late_plans)
    return [finished[drive.name] for drive in planned]


def require_same_drives(folder: Path, description: Mapping[str, str]) -> None:
    """Refuse a folder that holds something else than drives of one description.

    Raises:
        DataError: If it does.
    """
    path = folder / DESCRIPTION
    if not path.is_file():
        report.require_new(folder)
        return
    try:
        found = json.loads(path.read_text())
    except ValueError:
        found = {}
    names = sorted({*found, *description})
    differing = [name for name in names if found.get(name) != description.get(name)]
    if differing:
        raise DataError(
            f"'{folder}' holds other drives: they differ in {', '.join(differing)}. Expected the same, to go on with them. "
            f"Give another folder with --out."
        )


def _finished(folder: Path) -> DriveSummary | None:
    """The figures of a drive, which are written last; None if any of its files is not there or not whole."""
    if not all((folder / name).is_file() for name in report.FILES):
        return None
    try:
        store.read(folder / report.EPISODE)
        return config.read_json(DriveSummary, folder / report.SUMMARY)
    except (ConfigError, DataError):
        return None


def _keep(files: Mapping[str, bytes], folder: Path) -> None:
    """Write the files of a drive, its figures last: they say that the others are there."""
    for name in sorted(files, key=lambda name: name == report.SUMMARY):
        write_atomically(folder / name, files[name])


def _as_json(description: Mapping[str, str]) -> bytes:
    return (json.dumps(dict(description), indent=2, sort_keys=True) + "\n").encode()
