"""Who is asked what it thinks."""

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
import torch

from mjdrive.bev.projector import BevProjector
from mjdrive.config import Draws
from mjdrive.datatypes import Town
from mjdrive.learning.settings import acting_changed
from mjdrive.study.jobs import drivers
from mjdrive.study.jobs.drivers import Who
from mjdrive.study.jobs.driving import Place
from mjdrive.study.jobs.judging import Judged, JudgeJob, Judging, judge_all, read_record
from mjdrive.study.records.measures import Likelihood
from mjdrive.study.records.results import LandscapeRecord
from mjdrive.study.records.situations import Moment, situations
from mjdrive.study.settings.ablations import PAPERS_DFO
from mjdrive.vehicle import cars
from mjdrive.versions import all_versions
from models import checkpoint, presets
from models.checkpoint import RunState
from models.config import CommitmentConfig, LearnerConfig
from models.learners import build_learner

MOMENT = Moment("fork", "where the ways part", "approach", *[0.0] * 7)
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
            thought = LandscapeRecord(
                job.arm, job.variant, 0, MOMENT, 1, (1.0,), ((0.0, 0.0),), job.drawn_by
            )
            seen = () if job.landscapes is None else (thought,)
            yield job, Judged(Likelihood(1, floor, 0.0, None), None, seen)


def job(
    folder: Path,
    name: str,
    settings: LearnerConfig,
    digest: str,
    *,
    shown: bool,
    draws: Draws = "dfo",
) -> JudgeJob:
    who = Who(name, digest=digest, run=folder, settings=settings)
    return JudgeJob(
        who=who,
        arm=name,
        variant="flow",
        agent_seed=0,
        file=folder / f"{name}.json",
        landscapes=folder / "landscapes" if shown else None,
        draws=draws,
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


def asked(*jobs: JudgeJob) -> list[str]:
    """Who had to be asked."""
    executor: Any = Asking()
    judge_all(object.__new__(Judging), jobs, executor=executor, report=lambda *_: None)
    return executor.names


def test_who_was_asked_without_keeping_landscapes_is_asked_again_where_they_are_wanted(
    tmp_path: Path,
) -> None:
    hidden, shown = (job(tmp_path, "a", ANEW, "ab", shown=it) for it in (False, True))
    assert asked(hidden) == ["a"]
    assert asked(hidden) == []
    assert asked(shown) == ["a"]
    assert asked(shown) == []
    assert asked(hidden) == []


def test_an_energy_whose_landscapes_have_other_draws_than_wanted_is_asked_again(
    tmp_path: Path,
) -> None:
    for settings, expected in ((presets.quick("da-ibc"), ["a"]), (ANEW, [])):
        place = tmp_path / settings.method
        own, searched = (
            job(place, "a", settings, "ab", shown=True, draws=it) for it in ("own", "dfo")
        )
        assert asked(own) == ["a"]
        assert asked(searched) == expected, "what is no energy has draws of its own alone"
        assert asked(searched) == []


@pytest.mark.parametrize("method", ["da-ibc", "bc-grid"])
def test_landscapes_show_ten_draws_made_anew_of_the_papers_search_or_of_who_is_no_energy(
    method: str, town02: Town, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mjdrive.study.jobs.judging.situations", lambda town: situations(town)[:1])
    learner = build_learner(presets.preset("quick", method), seed=0)
    learner.prepare(torch.tensor([[0.5, 0.0], [-1.0, 0.3]]), torch.tensor([0.7, 0.2]))
    checkpoint.save(tmp_path / "run", learner, RunState(method, 0, 1, 1))
    assert learner.config.commitment.hold > 0
    who = drivers.agent("a", tmp_path / "run", learner.config, "float32")
    work = Judging(Place(town02, cars.load(), all_versions()), (), 1, 0)
    is_energy = method == "da-ibc"
    drawn: dict[str, tuple[tuple[float, float], ...]] = {}
    for draws in ("own", "dfo"):
        wanted = job(tmp_path, "a", learner.config, who.digest, shown=True, draws=draws)
        wanted = dataclasses.replace(wanted, who=who)
        (found,) = work.begin()(wanted, lambda done: None).landscapes
        assert found.drawn_by == (draws if is_energy else "own")
        drawn[draws] = found.draws
    settings = acting_changed(learner.config, PAPERS_DFO) if is_energy else learner.config
    drawer = drivers.load_learner(dataclasses.replace(who, settings=settings)).eval()
    seen = situations(town02)[0].observe(BevProjector(town02))
    bev, state = torch.tensor(seen.bev)[None], torch.tensor(seen.state)[None]
    generator = torch.Generator().manual_seed(0)
    expected = [drawer.act(bev, state, generator=generator)[0].tolist() for _ in range(10)]
    assert drawn["dfo"] == tuple(tuple(round(it, 6) for it in action) for action in expected)
    assert (drawn["own"] == drawn["dfo"]) == (not is_energy)
