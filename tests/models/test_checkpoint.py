import dataclasses

import pytest
import safetensors.torch
import torch

from models import checkpoint
from models.checkpoint import RunState, load, load_state, save, write_atomically
from models.errors import CheckpointError
from models.learners import build_learner

METHODS = ("bc-beta", "ibc", "da-ibc")


@pytest.fixture
def run(small_config, tmp_path):
    learner = build_learner(small_config("da-ibc"), seed=0)
    learner.prepare(torch.rand(5, 2), torch.rand(5))
    save(tmp_path / "run", learner, RunState("da-ibc", seed=0, epoch=1, epochs=2))
    return tmp_path / "run"


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("sampler", ["dfo", "grid"])
def test_a_loaded_learner_acts_as_the_saved_one(method, sampler, small_config, batch, tmp_path):
    config = small_config(method)
    config = dataclasses.replace(config, sampler=dataclasses.replace(config.sampler, kind=sampler))
    learner = build_learner(config, seed=1)
    learner.prepare(batch.actions, torch.ones(10))
    save(tmp_path, learner, RunState(method, seed=1, epoch=1, epochs=1))
    actions = [
        policy.act(batch.bev[:2], batch.state[:2], generator=torch.Generator().manual_seed(2))
        for policy in (learner, load(tmp_path))
    ]
    assert torch.equal(*actions)
    assert load(tmp_path).config == config


def test_the_state_survives(run):
    assert load_state(run) == RunState("da-ibc", seed=0, epoch=1, epochs=2)


@pytest.mark.parametrize("name", [checkpoint.MODEL, checkpoint.CONFIG])
def test_a_missing_file_is_named_with_what_is_there(name, run):
    (run / name).unlink()
    with pytest.raises(CheckpointError, match=f"expected {name}, found .*state.json"):
        load(run)


@pytest.mark.parametrize("name", [checkpoint.MODEL, checkpoint.CONFIG])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.99])
def test_a_truncated_file_is_named(name, share, run):
    content = (run / name).read_bytes()
    (run / name).write_bytes(content[: int(share * len(content))])
    with pytest.raises(CheckpointError, match=name):
        load(run)


@pytest.mark.parametrize("name", [checkpoint.MODEL, checkpoint.TRAINING])
@pytest.mark.parametrize("share", [0.2, 0.6, 0.999])
def test_a_flipped_bit_is_refused(name, share, run):
    path = run / name
    if name == checkpoint.TRAINING:
        checkpoint.write_tensors(path, {"weight/a": torch.ones(50, 50)}, epoch=1)
    content = bytearray(path.read_bytes())
    content[int(share * len(content))] ^= 1
    path.write_bytes(content)
    with pytest.raises(CheckpointError, match=r"is damaged: its tensors are not those"):
        checkpoint.read_tensors(path, device=torch.device("cpu"))


def test_tensors_of_before_there_were_digests_are_read(tmp_path):
    rows = {"a": torch.arange(3.0)}
    content = safetensors.torch.save(rows, metadata={"epoch": "4"})
    (tmp_path / "old.safetensors").write_bytes(content)
    tensors, epoch = checkpoint.read_tensors(
        tmp_path / "old.safetensors", device=torch.device("cpu")
    )
    assert epoch == 4
    assert torch.equal(tensors["a"], rows["a"])


def test_the_same_tensors_are_the_same_bytes(tmp_path):
    written = set()
    for _ in range(8):
        checkpoint.write_tensors(tmp_path / "x", {"a": torch.ones(2), "b": torch.ones(())}, epoch=1)
        written.add((tmp_path / "x").read_bytes())
    assert len(written) == 1


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(CheckpointError, match=r"There is no run folder '.*absent'"):
        load(tmp_path / "absent")


def test_a_folder_that_is_no_run_is_told_apart(tmp_path):
    with pytest.raises(CheckpointError, match=r"no complete training run: .*found nothing"):
        load(tmp_path)


def test_weights_of_another_network_are_refused(run, small_config):
    other = build_learner(small_config("bc-beta"), seed=0)
    checkpoint.write_tensors(run / checkpoint.MODEL, other.state_dict(), epoch=1)
    with pytest.raises(CheckpointError, match="does not fit the network"):
        load(run)


@pytest.mark.parametrize("value", [torch.nan, torch.inf])
def test_weights_that_are_not_finite_are_refused_by_name(value, run):
    tensors, _ = checkpoint.read_tensors(run / checkpoint.MODEL, device=torch.device("cpu"))
    tensors["energy.first.weight"][0, 0] = value
    checkpoint.write_tensors(run / checkpoint.MODEL, tensors, epoch=1)
    with pytest.raises(CheckpointError, match=r"not finite \(energy.first.weight\)"):
        load(run)


def test_a_damaged_state_is_refused(run):
    (run / checkpoint.STATE).write_text('{"epoch": 1, "colour": "red"}')
    with pytest.raises(CheckpointError, match=r"Cannot read '.*state.json'"):
        load_state(run)


def test_an_interrupted_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch):
    path = tmp_path / "file"
    write_atomically(path, b"old")

    def interrupt(descriptor):
        raise KeyboardInterrupt

    monkeypatch.setattr(checkpoint.os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
