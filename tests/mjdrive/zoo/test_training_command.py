import dataclasses
import shlex
from pathlib import Path

import pytest

from mjdrive.cli.train import train
from mjdrive.learning.settings import learner_settings
from mjdrive.zoo.training_command import in_use, training_command
from models import presets
from models.config import METHODS, LearnerConfig, Method


def settings_of(command: str) -> tuple[LearnerConfig, int, Path]:
    """What a call of `mjdrive train` trains with."""
    given = train.make_context("train", shlex.split(command)[2:]).params
    config = learner_settings(
        given["method"], preset=given["preset"], assignments=given["assignments"]
    )
    return config, given["seed"], given["data"]


@pytest.mark.parametrize("preset", presets.PRESETS)
def test_a_preset_is_named_and_nothing_is_set(preset: str) -> None:
    command = training_command(presets.preset(preset, "ibc"), seed=3, data=Path("d"))
    assert "--set" not in command
    assert settings_of(command) == (presets.preset(preset, "ibc"), 3, Path("d"))


def test_the_command_has_every_changed_setting() -> None:
    config = presets.standard("da-ibc")
    config = dataclasses.replace(
        config,
        network=dataclasses.replace(config.network, state_inputs=()),
        density=dataclasses.replace(config.density, weighting="sampler", cap=7.5),
        optimiser=dataclasses.replace(config.optimiser, precision="bfloat16", epochs=77),
    )
    command = training_command(config, seed=0, data=Path("a folder"))
    assert command.count("--set") == 5
    assert settings_of(command) == (config, 0, Path("a folder"))


@pytest.mark.parametrize("method", METHODS)
def test_settings_that_the_method_does_not_use_are_left_out(method: Method) -> None:
    config = presets.standard(method)
    other = dataclasses.replace(
        config,
        mixture=dataclasses.replace(config.mixture, components=9),
        flow=dataclasses.replace(config.flow, steps=99),
        sampler=dataclasses.replace(
            config.sampler, dfo=dataclasses.replace(config.sampler.dfo, iterations=9)
        ),
    )
    assert training_command(other, seed=0, data=Path("d")).count("--set") == (
        method in {"bc-mixture", "flow"}
    )


def test_settings_in_use_are_those_of_the_kind_of_sampler() -> None:
    names = in_use(presets.standard("da-ibc"))
    assert "sampler.grid.points" in names
    assert "negatives.sigma" in names
    assert not any(name.startswith(("sampler.dfo", "beta", "flow")) for name in names)
