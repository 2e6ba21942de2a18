"""Who drives, and in what."""

import dataclasses
from pathlib import Path

import pytest
import torch

from mjdrive.study.jobs import drivers
from mjdrive.study.jobs.drivers import Who
from models import presets
from models.config import CommitmentConfig
from models.learners import build_learner


@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_an_agent_acts_on_the_cpu_in_the_format_of_the_study_on_every_machine(
    monkeypatch: pytest.MonkeyPatch, precision: str
) -> None:
    learner = build_learner(presets.quick("da-ibc"), seed=0)
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
