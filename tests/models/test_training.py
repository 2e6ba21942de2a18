import dataclasses
import itertools
import json

import pytest
import torch

from models import checkpoint
from models.errors import CheckpointError, TrainingError
from models.interfaces import Batch, TensorDemonstrations
from models.learners import build_learner
from models.training import fit


class StoppedError(Exception):
    """What the tests stop a run with."""


def train(config, demonstrations, **kwargs):
    learner = build_learner(config, seed=3)
    history = fit(learner, demonstrations, config, **{"seed": 3, **kwargs})
    return learner, history


def stop(report):
    raise StoppedError


def assert_same(first, second):
    first, second = first.state_dict(), second.state_dict()
    assert first.keys() == second.keys()
    for name in first:
        assert torch.equal(first[name], second[name]), name


@pytest.mark.parametrize(("method", "per_pass"), [("bc-beta", 1), ("da-ibc", 1), ("bc-beta", 2)])
def test_a_resumed_run_ends_with_the_same_bits(
    method, per_pass, small_config, demonstrations, tmp_path
):
    config = small_config(
        method, schedule="onecycle", ema_decay=0.5, weight_decay=0.01, epochs_per_pass=per_pass
    )
    straight, history = train(config, demonstrations)
    with pytest.raises(StoppedError):
        train(config, demonstrations, folder=tmp_path, on_epoch=stop)
    resumed, resumed_history = train(config, demonstrations, folder=tmp_path, resume=True)
    assert_same(straight, resumed)
    assert_same(checkpoint.load(tmp_path), resumed)
    assert [r.loss for r in resumed_history] == [r.loss for r in history]


def test_an_epoch_broken_off_leaves_the_one_before(small_config, demonstrations, tmp_path):
    config = small_config("bc-beta")

    def stop_in_second_epoch(report):
        if report.step == 4:
            raise StoppedError

    with pytest.raises(StoppedError):
        train(config, demonstrations, folder=tmp_path, on_step=stop_in_second_epoch)
    assert checkpoint.load_state(tmp_path).epoch == 1
    assert len((tmp_path / "metrics.jsonl").read_text().splitlines()) == 1
    resumed, _ = train(config, demonstrations, folder=tmp_path, resume=True)
    assert_same(resumed, train(config, demonstrations)[0])


def test_the_seed_sets_the_weights_and_another_seed_sets_others(small_config, demonstrations):
    config = small_config("ibc", epochs=1)
    first, second = (train(config, demonstrations)[0] for _ in range(2))
    assert_same(first, second)
    other, _ = train(config, demonstrations, seed=4)
    assert not torch.equal(other.energy.last.weight, first.energy.last.weight)


def test_every_step_and_epoch_is_reported(small_config, demonstrations, tmp_path):
    steps, epochs = [], []
    config = small_config("bc-beta", validation_share=0.2)
    _, history = train(
        config, demonstrations, folder=tmp_path, on_step=steps.append, on_epoch=epochs.append
    )
    assert [step.step for step in steps] == [1, 2, 3, 4]  # 8 pairs of 10 in twos of 4, twice
    assert {step.num_steps for step in steps} == {4}
    assert epochs == history
    lines = (tmp_path / "metrics.jsonl").read_text().splitlines()
    assert [json.loads(line) for line in lines] == [dataclasses.asdict(r) for r in history]
    assert all(report.validation_loss is not None for report in history)


def test_training_learns_to_tell_two_pictures_apart(small_config, generator):
    bev = torch.zeros(16, 5, 192, 192, dtype=torch.uint8)
    bev[8:] = 255
    actions = torch.zeros(16, 2)
    actions[:, 1] = torch.where(torch.arange(16) < 8, 0.5, -0.5)
    data = TensorDemonstrations(Batch(bev, torch.zeros(16, 3), actions))
    config = small_config("bc-beta", learning_rate=1e-3, epochs=12, batch_size=8)
    learner, _ = train(config, data)
    chosen = learner.act(bev[[0, 15]], torch.zeros(2, 3), generator=generator)
    assert chosen[0, 1] > 0.2
    assert chosen[1, 1] < -0.2


def test_rare_actions_are_drawn_more_often(small_config, demonstrations):
    seen = []

    class Spy(TensorDemonstrations):
        def batch(self, indices):
            seen.extend(indices.tolist())
            return super().batch(indices)

    actions = torch.zeros(50, 2)
    actions[-1] = 1.0
    bev = torch.zeros(50, 5, 192, 192, dtype=torch.uint8)
    spy = Spy(Batch(bev, torch.zeros(50, 3), actions))
    train(small_config("bc-beta", epochs=2, batch_size=50), spy)
    assert 30 <= seen.count(49) <= 70  # half of 100 draws


def test_epochs_of_one_pass_see_each_pair_once(small_config, demonstrations):
    seen = []

    class Spy(TensorDemonstrations):
        def batch(self, indices):
            seen.append(indices.tolist())
            return super().batch(indices)

    config = small_config("bc-beta", epochs=6, epochs_per_pass=3)  # ten pairs in fours
    config = dataclasses.replace(
        config, density=dataclasses.replace(config.density, weighting="none")
    )
    steps = []
    train(config, Spy(demonstrations.batch(torch.arange(10))), on_step=steps.append)
    assert [len(it) for it in seen] == [4, 3, 3] * 2
    first, second = (list(itertools.chain(*seen[begin : begin + 3])) for begin in (0, 3))
    assert sorted(first) == sorted(second) == list(range(10))
    assert first != second
    assert [it.step for it in steps] == list(range(1, 7))
    assert {it.num_steps for it in steps} == {6}
    with pytest.raises(TrainingError, match="10 demonstrations cannot be cut into 11 epochs"):
        train(small_config("bc-beta", epochs_per_pass=11), demonstrations)


def test_loss_weights_reach_the_loss(small_config, demonstrations):
    config = small_config("bc-beta", epochs=1)
    results = []
    for weighting in ("loss", "none"):
        density = dataclasses.replace(config.density, weighting=weighting)
        results.append(train(dataclasses.replace(config, density=density), demonstrations)[1])
    assert results[0][0].loss != results[1][0].loss


def test_bfloat16_trains_close_to_float32(small_config, demonstrations):
    losses = [
        train(small_config("da-ibc", precision=precision), demonstrations)[1][-1].loss
        for precision in ("float32", "bfloat16")
    ]
    assert losses[1] == pytest.approx(losses[0], rel=0.02)


def test_a_folder_with_a_run_is_not_overwritten(small_config, demonstrations, tmp_path):
    config = small_config("bc-beta", epochs=1)
    train(config, demonstrations, folder=tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(CheckpointError, match="holds a training run already"):
        train(config, demonstrations, folder=tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_resuming_refuses_what_would_not_go_on_alike(small_config, demonstrations, tmp_path):
    config = small_config("bc-beta", epochs=1)
    with pytest.raises(CheckpointError, match="There is no run folder"):
        train(config, demonstrations, folder=tmp_path / "none", resume=True)
    train(config, demonstrations, folder=tmp_path)
    with pytest.raises(CheckpointError, match="other settings"):
        train(small_config("bc-beta", epochs=3), demonstrations, folder=tmp_path, resume=True)
    with pytest.raises(CheckpointError, match="seed 3, not 5"):
        train(config, demonstrations, folder=tmp_path, resume=True, seed=5)


def test_no_demonstrations_and_a_loss_without_bounds_are_refused(small_config, batch):
    config = small_config("bc-beta")
    with pytest.raises(TrainingError, match="no demonstrations"):
        train(config, TensorDemonstrations(Batch(*(x[:0] for x in batch))))
    broken = batch._replace(state=torch.full((10, 3), torch.nan))
    with pytest.raises(TrainingError, match="The loss is nan at step 0 of epoch 1"):
        train(config, TensorDemonstrations(broken))


def test_a_save_broken_off_between_its_files_is_mended_by_resuming(
    small_config, demonstrations, tmp_path
):
    config = small_config("bc-beta")
    with pytest.raises(StoppedError):
        train(config, demonstrations, folder=tmp_path, on_epoch=stop)
    files = (checkpoint.MODEL, checkpoint.STATE)
    first_epoch = {name: (tmp_path / name).read_bytes() for name in files}
    train(config, demonstrations, folder=tmp_path, resume=True)
    whole = {name: (tmp_path / name).read_bytes() for name in files}
    assert whole != first_epoch
    for name in files:
        (tmp_path / name).write_bytes(first_epoch[name])
    train(config, demonstrations, folder=tmp_path, resume=True)
    assert {name: (tmp_path / name).read_bytes() for name in files} == whole
    (tmp_path / checkpoint.METRICS).write_text("not JSON\n")
    with pytest.raises(CheckpointError, match="Expected one line of JSON an epoch"):
        train(config, demonstrations, folder=tmp_path, resume=True)


def test_leftovers_of_a_first_epoch_broken_off_are_no_run(small_config, demonstrations, tmp_path):
    config = small_config("bc-beta", epochs=1)
    (tmp_path / checkpoint.TRAINING).write_bytes(b"cut")
    train(config, demonstrations, folder=tmp_path)
    assert checkpoint.load_state(tmp_path).epoch == 1
