"""Ask the agents of a study what they think: of what the expert did, and of every action at the moments of the pictures."""

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from mjdrive import config
from mjdrive.bev.projector import BevProjector
from mjdrive.config import Draws
from mjdrive.datatypes import Episode
from mjdrive.execution.work import Executor, Tell
from mjdrive.learning.settings import acting_changed
from mjdrive.study.jobs import landscapes
from mjdrive.study.jobs.drivers import Who, load_learner
from mjdrive.study.jobs.driving import Place
from mjdrive.study.jobs.held_out import HeldOut, held_out, judge
from mjdrive.study.jobs.sharing import Report, do_all
from mjdrive.study.records import folder
from mjdrive.study.records.measures import LandscapeFigures, Likelihood
from mjdrive.study.records.results import LandscapeRecord
from mjdrive.study.records.situations import Moment, situations
from mjdrive.study.settings.ablations import PAPERS_DFO
from mjdrive.versions import require_same
from models.config import density_settings, settings_of
from models.interfaces import Learner
from models.threads import one_thread

_DIGITS = 9
"""Probabilities are kept to so many decimals; cells of less than half of the last are zero."""


@dataclass(frozen=True, slots=True)
class JudgeJob:
    """One agent in one way to act to be asked.

    Attributes:
        who: The agent.
        arm: Name of its arm.
        variant: Name of its variant.
        agent_seed: Its training seed [-].
        file: Where the record goes.
        landscapes: Folder for what it thinks at the moments of the pictures; None if that is not kept.
        draws: Whose draws are shown there.
        seed: Decides the actions that are drawn there.
    """

    who: Who
    arm: str
    variant: str
    agent_seed: int
    file: Path
    landscapes: Path | None
    draws: Draws
    seed: int

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.who.name}, likelihood"

    @property
    def drawn_by(self) -> Draws:
        """Whose draws are shown of this agent: only energies can be searched."""
        assert self.who.settings is not None, "references do not think"
        is_energy = "sampler." in settings_of(self.who.settings.method)
        return self.draws if is_energy else "own"


@dataclass(frozen=True, slots=True)
class JudgeRecord:
    """What an agent thinks.

    Attributes:
        digest: SHA-256 of its weights, hexadecimal.
        likelihood: How likely it finds what the expert does; None if there is nothing held out.
        landscape: How many ways to act it sees at junctions; None likewise.
        landscapes: Names of the files with what it thinks at the moments of the pictures.
    """

    digest: str
    likelihood: Likelihood | None
    landscape: LandscapeFigures | None
    landscapes: tuple[str, ...]


class Judged(NamedTuple):
    """An agent that was asked; as in `JudgeRecord`, with the landscapes themselves."""

    likelihood: Likelihood | None
    landscape: LandscapeFigures | None
    landscapes: tuple[LandscapeRecord, ...]


@dataclass(frozen=True, eq=False)
class Judging:
    """Asks agents.

    Attributes:
        place: Where the expert's walk and the moments of the pictures are.
        walk: Episodes of the walk; none if nothing is held out.
        num_frames: Moments of it to ask about [-].
        seed: Decides which.
    """

    place: Place
    walk: tuple[Episode, ...]
    num_frames: int
    seed: int

    def begin(self) -> Callable[[JudgeJob, Tell], Judged]:
        """Draw what is seen; what comes back asks one agent."""
        require_same(self.place.versions)
        town = self.place.town
        walk = None
        if self.walk:
            rng = np.random.default_rng(self.seed)
            walk = held_out(self.walk, town, num_frames=self.num_frames, rng=rng)
        moments, projector = situations(town), BevProjector(town)
        return lambda job, tell: _ask(job, walk, moments, projector)


def judge_all(
    work: Judging, jobs: Sequence[JudgeJob], *, executor: Executor, report: Report
) -> None:
    """Ask the agents that have not been asked yet; who thinks the same as another and only acts otherwise is not asked twice.

    Args:
        work: What they are asked.
        jobs: The agents.
        executor: Where the work is done; the files do not depend on it.
        report: Told who has been asked.

    Raises:
        RunError: If the run of an agent cannot be loaded.
        WorkerError: If a process was lost.
    """
    asked = _asked(jobs)
    do_all(
        work,
        list(dict.fromkeys(asked.values())),
        size=lambda job: 1,
        is_done=lambda job: read_record(job) is not None,
        keep=lambda job, judged: config.write_json(_kept(job, judged), job.file),
        executor=executor,
        report=report,
    )
    for job, other in asked.items():
        if job is other:
            continue
        if read_record(job) is None:
            found = read_record(other)
            assert found is not None, "it has been asked"
            config.write_json(dataclasses.replace(found, landscapes=()), job.file)
        report(job.name, 1, 1)


def _asked(jobs: Sequence[JudgeJob]) -> dict[JudgeJob, JudgeJob]:
    """Who is asked for each agent: itself where its landscapes are kept, else the first with its density."""
    first: dict[object, JudgeJob] = {}
    for job in sorted(jobs, key=lambda it: it.landscapes is None):
        first.setdefault(_density(job.who), job)
    return {job: job if job.landscapes else first[_density(job.who)] for job in jobs}


def _density(who: Who) -> object:
    """What decides what somebody thinks."""
    assert who.settings is not None, "references do not think"
    return who.digest, density_settings(who.settings), who.precision


def read_record(job: JudgeJob) -> JudgeRecord | None:
    """What an agent thinks; None if it has not been asked yet, had other weights, or its landscapes are wanted and not there."""
    found = folder.read(JudgeRecord, job.file)
    is_whole = found is not None and found.digest == job.who.digest and _has_landscapes(job, found)
    return found if is_whole else None


def _has_landscapes(job: JudgeJob, found: JudgeRecord) -> bool:
    """Whether there are landscapes with the draws that are wanted, if any are kept; a study that kept none named none."""
    if job.landscapes is None:
        return True
    kept = [folder.read(LandscapeRecord, job.landscapes / name) for name in found.landscapes]
    is_drawn = all(it is not None and it.drawn_by == job.drawn_by for it in kept)
    return bool(kept) and is_drawn


def _kept(job: JudgeJob, judged: Judged) -> JudgeRecord:
    """Write the landscapes, and describe all."""
    names = []
    for it in judged.landscapes:
        assert job.landscapes is not None, "only landscapes that are kept are measured"
        names.append(f"{job.who.name}-{it.moment.name}.json")
        config.write_json(it, job.landscapes / names[-1])
    return JudgeRecord(job.who.digest, judged.likelihood, judged.landscape, tuple(names))


def _ask(
    job: JudgeJob, walk: HeldOut | None, moments: tuple[Moment, ...], projector: BevProjector
) -> Judged:
    learner = load_learner(job.who).eval()
    likelihood, landscape = (None, None) if walk is None else judge(learner, walk)
    if job.landscapes is None:
        return Judged(likelihood, landscape, ())
    with one_thread():
        seen = landscapes.measure(
            learner, moments, projector, seed=job.seed, drawer=_drawer(job, learner)
        )
    records = tuple(
        LandscapeRecord(
            arm=job.arm,
            variant=job.variant,
            seed=job.agent_seed,
            moment=moment,
            points=len(it.probabilities),
            probabilities=tuple(np.round(it.probabilities.ravel(), _DIGITS).tolist()),
            draws=tuple((round(a, 6), round(s, 6)) for a, s in it.draws.tolist()),
            drawn_by=job.drawn_by,
        )
        for moment, it in zip(moments, seen, strict=True)
    )
    return Judged(likelihood, landscape, records)


def _drawer(job: JudgeJob, learner: Learner) -> Learner:
    """Who draws the actions of the landscapes: the agent as it acts, or the same energy searched as the paper does."""
    if job.drawn_by == "own":
        return learner
    assert job.who.settings is not None, "references do not think"
    searched = acting_changed(job.who.settings, PAPERS_DFO)
    return load_learner(dataclasses.replace(job.who, settings=searched)).eval()
