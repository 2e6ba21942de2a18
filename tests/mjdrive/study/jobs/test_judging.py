"""Who is asked what it thinks."""

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from mjdrive.study.jobs.drivers import Who
from mjdrive.study.jobs.judging import Judged, JudgeJob, Judging, judge_all, read_record
from mjdrive.study.records.measures import Likelihood
from models import presets
from models.config import CommitmentConfig, LearnerConfig

COMMITTED = presets.quick("flow")
ANEW = dataclasses.replace(COMMITTED, commitment=CommitmentConfig(hold=0))
SHARPER = dataclasses.replace(ANEW, denoiser=dataclasses.replace(ANEW.denoiser, noise_floor=0.01))


class Asking:
    """An executor that answers by the noise floor, and keeps who was asked."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def run(
        self, work: object, jobs: Sequence[JudgeJob], *, on_progress: Callable[..., None]
    ) -> Iterator[tuple[JudgeJob, Judged]]:
        del work, on_progress
        for job in jobs:
            assert job.who.settings is not None
            self.names.append(job.who.name)
            floor = job.who.settings.denoiser.noise_floor
            yield job, Judged(Likelihood(1, floor, 0.0, None), None, ())


def job(folder: Path, name: str, settings: LearnerConfig, digest: str, *, shown: bool) -> JudgeJob:
    who = Who(name, digest=digest, run=folder, settings=settings)
    return JudgeJob(
        who=who,
        arm=name,
        variant="flow",
        agent_seed=0,
        file=folder / f"{name}.json",
        landscapes=folder if shown else None,
        seed=0,
    )


def test_who_thinks_the_same_and_only_acts_otherwise_is_asked_once(tmp_path: Path) -> None:
    jobs = [
        job(tmp_path, "anew", ANEW, "ab", shown=False),
        job(tmp_path, "committed", COMMITTED, "ab", shown=True),
        job(tmp_path, "sharper", SHARPER, "ab", shown=False),
        job(tmp_path, "another", COMMITTED, "cd", shown=False),
    ]
    told: list[str] = []
    for expected in ({"committed", "sharper", "another"}, set()):
        executor: Any = Asking()
        told.clear()
        judge_all(
            object.__new__(Judging),  # nobody who answers here needs anything of it
            jobs,
            executor=executor,
            report=lambda name, done, size: told.append(name) if done == size else None,
        )
        assert set(executor.names) == expected
        assert sorted(told) == sorted(it.name for it in jobs)
    floors = [read_record(it).likelihood for it in jobs]  # type: ignore[union-attr]
    assert floors[0] == floors[1] == floors[3] != floors[2]
