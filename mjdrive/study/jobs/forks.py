"""Let agents live the same moments before junctions again and again."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

from mjdrive import config
from mjdrive.datatypes import Episode, Town
from mjdrive.episodes import store
from mjdrive.evaluation.choices import approaches
from mjdrive.evaluation.forking import Fork, ForkOutcome, find_forks
from mjdrive.execution.work import Executor, Tell
from mjdrive.files import write_atomically
from mjdrive.simulation.simulation import Simulation
from mjdrive.study.jobs.drivers import Who, load_pilot
from mjdrive.study.jobs.driving import Place
from mjdrive.study.jobs.sharing import Report, do_all
from mjdrive.study.records import fans, folder
from mjdrive.study.records.fans import FanRecord
from mjdrive.study.records.results import Turn
from mjdrive.study.records.situations import situations


@dataclass(frozen=True, slots=True)
class ForkJob:
    """One moment to be lived by one agent.

    Attributes:
        who: The agent.
        arm: Name of its arm.
        agent_seed: Its training seed [-].
        approach: Name of the lane that leads to the junction.
        file: Where the record goes.
        turns: Folder for one drive through each exit; None if none is kept.
        num_rollouts: How often it is lived [-].
        seed: Decides the moment and the agent's own chance.
    """

    who: Who
    arm: str
    agent_seed: int
    approach: str
    file: Path
    turns: Path | None
    num_rollouts: int
    seed: int

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.who.name}, moments before {self.approach}"


@dataclass(frozen=True, slots=True)
class ForkRecord:
    """What became of one moment.

    Attributes:
        digest: SHA-256 of the weights that drove, hexadecimal.
        outcome: What is counted; None if the expert cannot drive up to the junction.
        fan: The ways that were taken; None likewise.
        turns: Drives through the exits that were kept.
    """

    digest: str
    outcome: ForkOutcome | None
    fan: FanRecord | None
    turns: tuple[Turn, ...]


class Lived(NamedTuple):
    """A moment that was lived.

    Attributes:
        outcome: What is counted; None if there is no such moment.
        fan: The ways that were taken; None likewise.
        drives: An episode file for each exit that was taken, by name of the exit.
    """

    outcome: ForkOutcome | None
    fan: FanRecord | None
    drives: dict[str, bytes]


@dataclass(frozen=True, eq=False)
class Forking:
    """Lives moments in a place."""

    place: Place

    def begin(self) -> Callable[[ForkJob, Tell], Lived]:
        """Build the simulation; what comes back lives one moment as often as its job says."""
        return partial(_live, self.place.simulation(), functools.cache(_find))


def chosen_approaches(town: Town, count: int) -> tuple[str, ...]:
    """Name approaches to junctions: first that of the pictures, then others from all over the town.

    Args:
        town: Where.
        count: How many [-]; all there are if there are fewer.
    """
    names = [approach.lane for approach in approaches(town)]
    first = situations(town)[0].approach
    others = [name for name in names if name != first]
    if count <= 1 or not others:
        return (first,)[:count]
    step = max(1, len(others) // (count - 1))
    return (first, *others[::step][: count - 1])


def live_forks(
    place: Place, jobs: Sequence[ForkJob], *, executor: Executor, report: Report
) -> None:
    """Live the moments that are missing.

    Args:
        place: Where.
        jobs: The moments and who lives them.
        executor: Where the work is done; the files do not depend on it.
        report: Told how far each moment is.

    Raises:
        RunError: If the run of an agent cannot be loaded.
        WorkerError: If a process was lost.
    """
    do_all(
        Forking(place),
        jobs,
        size=lambda job: job.num_rollouts,
        is_done=lambda job: read_record(job) is not None,
        keep=lambda job, lived: config.write_json(_kept(job, lived, place.town), job.file),
        executor=executor,
        report=report,
    )


def read_record(job: ForkJob) -> ForkRecord | None:
    """What became of a moment; None if it is still to be lived, or was lived with other weights or without the turns that are wanted."""
    found = folder.read(ForkRecord, job.file)
    is_whole = found is not None and found.digest == job.who.digest and _has_turns(job, found)
    return found if is_whole else None


def _has_turns(job: ForkJob, found: ForkRecord) -> bool:
    """Whether a drive is there through each exit that was taken safely, if turns are kept; a study that kept none left none."""
    if job.turns is None:
        return True
    paths = () if found.fan is None else found.fan.paths
    taken = {it.exit for it in paths if it.is_safe and it.exit}
    is_kept = taken == {it.exit for it in found.turns}
    return is_kept and all((job.turns.parent / it.file).is_file() for it in found.turns)


def _kept(job: ForkJob, lived: Lived, town: Town) -> ForkRecord:
    """Write the drives that are kept, and describe all."""
    turns = []
    if job.turns is not None and lived.outcome is not None:
        for index, exit in enumerate(lived.outcome.taken):
            if exit not in lived.drives:
                continue
            file = job.turns / f"{job.who.name}-{index}.hdf5"
            write_atomically(file, lived.drives[exit])
            move = town.lanes[exit].move.name.lower()
            name = f"{job.turns.name}/{file.name}"
            turns.append(Turn(job.arm, job.agent_seed, job.approach, exit, move, name))
    return ForkRecord(job.who.digest, lived.outcome, lived.fan, tuple(turns))


def _find(simulation: Simulation, approach: str, seed: int) -> Fork | None:
    return next(iter(find_forks(simulation, seed=seed, names=[approach])), None)


def _live(
    simulation: Simulation,
    find: Callable[[Simulation, str, int], Fork | None],
    job: ForkJob,
    tell: Tell,
) -> Lived:
    fork = find(simulation, job.approach, job.seed)
    if fork is None:
        return Lived(None, None, {})
    drives: dict[str, bytes] = {}

    def keep(drive: Episode, is_safe: bool) -> None:
        exit = fans.exit_of(drive, fork, simulation.town)
        if is_safe and exit and exit not in drives and job.turns is not None:
            drives[exit] = store.to_bytes(drive)

    outcome, fan = fans.live(
        simulation,
        fork,
        load_pilot(job.who),
        arm=job.arm,
        agent_seed=job.agent_seed,
        seed=job.seed,
        num_rollouts=job.num_rollouts,
        on_rollout=tell,
        on_drive=keep,
    )
    return Lived(outcome, fan, drives)
