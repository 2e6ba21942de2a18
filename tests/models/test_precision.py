import dataclasses
import json

import pytest
import torch

from models import checkpoint, hardware, precision
from models.learners import build_learner
from models.serialization import from_json, to_json
from models.training import fit

CPU = torch.device("cpu")


@pytest.fixture
def fast(monkeypatch):
    """Set whether the machine is fast in bfloat16."""

    def set_fast(is_fast):
        monkeypatch.setattr(hardware, "bfloat16_is_fast", lambda device="cpu": is_fast)

    return set_fast


@pytest.mark.parametrize("outcome", [(True, "bfloat16"), (False, "float32")])
def test_auto_is_what_the_machine_is_fast_at_and_is_recorded(
    fast, outcome, small_config, demonstrations, tmp_path
):
    is_fast, expected = outcome
    fast(is_fast)
    config = small_config("bc-beta", precision="auto", epochs=1)
    fit(build_learner(config, seed=0), demonstrations, config, folder=tmp_path)
    assert checkpoint.load_config(tmp_path).optimiser.precision == expected


def test_a_run_goes_on_in_the_number_format_that_it_began_in(
    fast, small_config, demonstrations, tmp_path
):
    config = small_config("bc-beta", precision="auto")

    def stop(report):
        raise InterruptedError

    fast(True)
    straight = build_learner(config, seed=0)
    fit(straight, demonstrations, config)
    with pytest.raises(InterruptedError):
        fit(build_learner(config, seed=0), demonstrations, config, folder=tmp_path, on_epoch=stop)
    fast(False)  # another machine
    resumed = build_learner(config, seed=0)
    fit(resumed, demonstrations, config, folder=tmp_path, resume=True)
    assert resumed.config.optimiser.precision == "bfloat16"
    for name, tensor in straight.state_dict().items():
        assert torch.equal(tensor, resumed.state_dict()[name]), name


def test_what_is_asked_for_is_taken_and_slowness_is_told(fast, small_config):
    config = small_config("ibc", precision="bfloat16")
    fast(False)
    assert precision.settle(config, device="cpu") == config
    assert "which is slow here" in precision.in_words(config, device=CPU)
    fast(True)
    assert precision.in_words(config, device=CPU) == "Training on cpu in bfloat16."
    exact = small_config("ibc", precision="float32")
    assert "bfloat16 is quicker here" in precision.in_words(exact, device=CPU)


@pytest.mark.parametrize("recorded", ["float32", "bfloat16"])
def test_settings_of_older_runs_load_as_they_were(recorded, small_config):
    config = small_config("da-ibc", precision=recorded)
    config = dataclasses.replace(
        config, sampler=dataclasses.replace(config.sampler, precision="float32")
    )
    settings = json.loads(to_json(config))
    del settings["sampler"]["precision"]  # older runs have none, and act in what is fast
    loaded = from_json(json.dumps(settings))
    assert loaded.optimiser == config.optimiser
    assert loaded.sampler == dataclasses.replace(config.sampler, precision="auto")


@pytest.mark.parametrize(
    ("is_fast", "recorded", "note"),
    [
        (False, "bfloat16", "Training on cpu in bfloat16, as this run began; that is slow here."),
        (True, "float32", "Training on cpu in float32, as this run began."),
    ],
)
def test_a_run_that_goes_on_is_given_no_advice_that_would_be_refused(
    fast, small_config, is_fast, recorded, note
):
    fast(is_fast)
    config = small_config("ibc", precision=recorded)
    assert precision.in_words(config, device=CPU, resumes=True) == note
