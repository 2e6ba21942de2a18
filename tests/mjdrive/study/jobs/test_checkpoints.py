"""Which epochs of a run are kept, and whose run a folder holds."""

import dataclasses
import json
from pathlib import Path

import pytest

from mjdrive.config import Variant
from mjdrive.errors import RunError
from mjdrive.study.jobs import checkpoints
from mjdrive.study.settings.agents import Agent, learner_config
from models import serialization
from models.config import LangevinConfig, LearnerConfig


def put(run: Path, epoch: int, *, epochs: int = 6, seed: int = 0, weights: str = "") -> Path:
    """What a run folder holds after an epoch, as far as copies of it care."""
    run.mkdir(parents=True, exist_ok=True)
    state = {
        "method": "bc-beta",
        "seed": seed,
        "epoch": epoch,
        "epochs": epochs,
        "torch_version": "2",
    }
    (run / "state.json").write_text(json.dumps(state))
    for name in ("config.json", "source.json", "training.safetensors"):
        (run / name).write_text(name)
    (run / "model.safetensors").write_text(weights or f"weights of epoch {epoch}")
    return run


def test_every_second_epoch_is_kept_once_and_the_last_one_is_the_run_itself(tmp_path: Path) -> None:
    run = tmp_path / "run"
    for epoch in range(1, 7):
        put(run, epoch)
        checkpoints.keep_epoch(run, every=2)
    kept = checkpoints.kept_epochs(run)
    assert sorted(kept) == [2, 4, 6]
    assert kept[6] == run
    assert (kept[4] / "model.safetensors").read_text() == "weights of epoch 4"
    assert not (kept[4] / "training.safetensors").exists()


def test_what_is_kept_is_not_touched_again_and_half_a_copy_is_made_anew(tmp_path: Path) -> None:
    run = put(tmp_path / "run", 2)
    half = run / checkpoints.EPOCHS / ".0002"
    half.mkdir(parents=True)
    (half / "rubbish").write_text("")
    checkpoints.keep_epoch(run, every=2)
    put(run, 2, weights="others")
    checkpoints.keep_epoch(run, every=2)
    kept = checkpoints.kept_epochs(run)[2]
    assert kept == run, "the last epoch of a run is the run itself"
    copy = run / checkpoints.EPOCHS / "0002"
    assert (copy / "model.safetensors").read_text() == "weights of epoch 2"
    assert not (copy / "rubbish").exists()


def test_nothing_is_kept_where_nobody_asks(tmp_path: Path) -> None:
    run = put(tmp_path / "run", 2)
    checkpoints.keep_epoch(run, every=0)
    assert not (run / checkpoints.EPOCHS).exists()


@pytest.mark.parametrize("name", ["bc-beta-1", "bc-beta"])
def test_a_run_is_found_by_its_agent_or_its_method_if_the_seed_is_right(
    tmp_path: Path, name: str
) -> None:
    put(tmp_path / name, 6, seed=1)
    variant = Variant("bc-beta", "bc-beta")
    assert checkpoints.find_run(Agent(variant, 1), tmp_path) == tmp_path / name
    assert checkpoints.find_run(Agent(variant, 0), tmp_path) is None


def test_only_settings_with_an_effect_on_the_method_tell_runs_apart(tmp_path: Path) -> None:
    agent = Agent(Variant("bc-beta", "bc-beta"), 0)
    planned = learner_config(agent.variant)
    run = put(tmp_path / "run", 6)

    def trained_with(**changes: object) -> None:
        other = dataclasses.replace(planned, **changes)  # type: ignore[arg-type]
        (run / "config.json").write_text(serialization.to_json(other))

    trained_with(negatives=dataclasses.replace(planned.negatives, count=7))
    checkpoints.require_planned(run, agent, planned)
    trained_with(beta=dataclasses.replace(planned.beta, label_noise=0.5))
    with pytest.raises(RunError, match=r"beta\.label_noise 0\.5 \(here 0\.05\)"):
        checkpoints.require_planned(run, agent, planned)


def changed(planned: LearnerConfig, group: str, **changes: object) -> LearnerConfig:
    """The same settings, but for some of one group."""
    return dataclasses.replace(
        planned, **{group: dataclasses.replace(getattr(planned, group), **changes)}
    )


def test_runs_that_drew_pairs_otherwise_are_refused(tmp_path: Path) -> None:
    agent = Agent(Variant("flow", "flow"), 0)
    planned = learner_config(agent.variant)
    run = put(tmp_path / "run", 6)
    other = changed(planned, "evenness", speed_exponent=0.5)
    (run / "config.json").write_text(serialization.to_json(other))
    with pytest.raises(RunError, match=r"evenness\.speed_exponent 0\.5"):
        checkpoints.require_planned(run, agent, planned)


@pytest.mark.parametrize(
    ("method", "group", "changes"),
    [
        ("da-ibc", "commitment", {"hold": 7}),
        ("da-ibc", "sampler", {"precision": "bfloat16"}),
        ("ibc", "sampler", {"langevin": LangevinConfig(7)}),
        ("bc-beta", "beta", {"inference": "mean"}),
    ],
)
def test_a_run_that_would_act_otherwise_is_taken(
    tmp_path: Path, method: str, group: str, changes: dict[str, object]
) -> None:
    agent = Agent(Variant(method, method), 0)
    planned = learner_config(agent.variant)
    run = put(tmp_path / "run", 6)
    (run / "config.json").write_text(serialization.to_json(changed(planned, group, **changes)))
    checkpoints.require_planned(run, agent, planned)


def test_a_run_that_is_not_finished_is_not_taken(tmp_path: Path) -> None:
    put(tmp_path / "bc-beta", 5)
    assert checkpoints.find_run(Agent(Variant("bc-beta", "bc-beta"), 0), tmp_path) is None
