"""Who drives, and in what."""

import dataclasses
import pickle
import shutil
from pathlib import Path

import pytest
import torch

from mjdrive.errors import RunError
from mjdrive.study.jobs import drivers
from mjdrive.study.jobs.drivers import Who
from models import checkpoint, presets
from models.checkpoint import RunState
from models.config import CommitmentConfig
from models.learners import build_learner


@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_an_agent_acts_on_the_cpu_in_the_format_of_the_study_on_every_machine(
    monkeypatch: pytest.MonkeyPatch, precision: str
) -> None:
    learner = build_learner(presets.preset("paper", "da-ibc"), seed=0)
    assert learner.config.sampler.precision == "auto"
    monkeypatch.setattr("models.checkpoint.load", lambda run: learner)
    monkeypatch.setattr(drivers, "digest", lambda run: "ab")
    monkeypatch.setattr("mjdrive.learning.pilot.choose_device", lambda: torch.device("meta"))
    monkeypatch.setattr(
        "models.hardware.bfloat16_is_fast", lambda device="cpu": precision == "float32"
    )
    who = Who("a", digest="ab", run=Path("a"), settings=learner.config, precision=precision)
    pilot = drivers.load_pilot(who)
    assert pilot.device == torch.device("cpu")
    assert pilot.config.sampler.precision == precision


def test_an_agent_scores_grids_in_float32_whatever_the_format_of_the_study(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    learner = build_learner(presets.quick("da-ibc"), seed=0)
    assert learner.config.sampler.kind == "grid"
    monkeypatch.setattr("models.checkpoint.load", lambda run: learner)
    monkeypatch.setattr(drivers, "digest", lambda run: "ab")
    monkeypatch.setattr("models.hardware.bfloat16_is_fast", lambda device="cpu": True)
    who = Who("a", digest="ab", run=Path("b"), settings=learner.config, precision="bfloat16")
    assert drivers.load_pilot(who).config.sampler.precision == "float32"


def test_an_agent_keeps_a_format_that_its_settings_name(monkeypatch: pytest.MonkeyPatch) -> None:
    learner = build_learner(presets.quick("da-ibc"), seed=0)
    sampler = dataclasses.replace(learner.config.sampler, precision="bfloat16")
    learner.config = dataclasses.replace(learner.config, sampler=sampler)
    monkeypatch.setattr("models.checkpoint.load", lambda run: learner)
    monkeypatch.setattr(drivers, "digest", lambda run: "ab")
    who = Who("a", digest="ab", run=Path("a"), settings=learner.config, precision="float32")
    found = drivers.load_learner(who)
    assert found.config.sampler.precision == "bfloat16"


def test_an_agent_acts_as_the_study_says_whatever_its_run_has(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    planned = presets.quick("da-ibc")
    other = dataclasses.replace(planned, commitment=CommitmentConfig(hold=7))
    settled = dataclasses.replace(other.optimiser, precision="bfloat16")
    learner = build_learner(dataclasses.replace(other, optimiser=settled), seed=0)
    monkeypatch.setattr("models.checkpoint.load", lambda run: learner)
    monkeypatch.setattr(drivers, "digest", lambda run: "ab")
    found = drivers.load_learner(Who("a", digest="ab", run=Path("a"), settings=planned)).config
    assert found.commitment == planned.commitment != other.commitment
    assert found.optimiser == settled  # what it was trained with


@pytest.fixture
def agent(tmp_path: Path) -> Who:
    """An agent that has learnt nothing, with a run folder of its own."""
    learner = build_learner(presets.quick("bc-beta"), seed=0)
    checkpoint.save(tmp_path / "run", learner, RunState("bc-beta", 0, 1, 1))
    return drivers.agent("a", tmp_path / "run", learner.config, "float32")


def test_an_agent_that_is_sent_acts_where_nobody_sees_its_run(agent: Who) -> None:
    here = drivers.load_learner(agent).state_dict()
    sent = pickle.dumps(agent)
    assert agent.run is not None
    shutil.rmtree(agent.run)
    arrived = pickle.loads(sent)
    assert (arrived, hash(arrived)) == (agent, hash(agent))
    there = drivers.load_learner(pickle.loads(pickle.dumps(arrived))).state_dict()
    assert here.keys() == there.keys()
    assert all(torch.equal(here[name], there[name]) for name in here)


def test_an_agent_whose_run_changed_is_not_sent(agent: Who) -> None:
    assert agent.run is not None
    other = build_learner(presets.quick("bc-beta"), seed=1)
    checkpoint.save(agent.run, other, RunState("bc-beta", 1, 1, 1))
    with pytest.raises(RunError, match=f"run '{agent.run}' has changed since the study began"):
        pickle.dumps(agent)
    (agent.run / checkpoint.MODEL).unlink()
    with pytest.raises(RunError, match="has changed since the study began"):
        pickle.dumps(agent)


def test_what_is_wrong_with_a_run_that_was_sent_is_said_of_the_run_here(agent: Who) -> None:
    assert agent.run is not None
    (agent.run / checkpoint.CONFIG).write_text("{")
    arrived = pickle.loads(pickle.dumps(agent))
    with pytest.raises(RunError, match=f"'{agent.run / checkpoint.CONFIG}'"):
        drivers.load_learner(arrived)
