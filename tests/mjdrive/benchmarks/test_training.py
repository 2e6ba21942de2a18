import math
from pathlib import Path

import pytest
import torch

from mjdrive.benchmarks import carried, memory, training
from mjdrive.benchmarks.comparison import Figure, Plan
from mjdrive.benchmarks.naive_training import NaiveLoop
from mjdrive.episodes import dataset
from mjdrive.errors import WorkerError
from mjdrive.learning import runs
from mjdrive.learning.batches import PackedDemonstrations
from models import presets
from models.ibc import IbcLearner
from models.interfaces import Batch
from models.learners import build_learner

NUM = 12


@pytest.fixture(scope="module")
def pairs() -> PackedDemonstrations:
    return carried.demonstrations(NUM)


def test_carried_demonstrations_show_a_road_and_keep_to_the_box(
    pairs: PackedDemonstrations,
) -> None:
    batch = pairs.batch(torch.arange(NUM))
    assert len(pairs) == NUM
    assert (batch.bev[:, 0] > 0).float().mean(dim=(1, 2)).min() > 0.05
    assert batch.actions.abs().max() <= 1


@pytest.mark.parametrize("method", list(training.LEAST))
def test_both_sides_train_networks_of_the_same_size(
    method: str, pairs: PackedDemonstrations
) -> None:
    ours = build_learner(presets.preset("paper", method), seed=0)
    theirs = NaiveLoop(pairs, batch_size=4, num_negatives=0 if method == "bc-beta" else 3)
    sizes = [
        sum(parameter.numel() for module in modules for parameter in module.parameters())
        for modules in ((ours,), (theirs._encoder, theirs._head))
    ]
    # The naive head of BC-Beta has one output layer, ours two of half its size.
    assert sizes[0] == sizes[1]


def test_the_naive_loop_has_the_loss_of_ours(pairs: PackedDemonstrations) -> None:
    """At first weights every energy is near the same: the loss is the log of the number of candidates."""
    loop = NaiveLoop(pairs, batch_size=6, num_negatives=3)
    losses = loop()
    assert losses == pytest.approx([1.386, 1.386], abs=0.05)
    ours = build_learner(presets.preset("paper", "da-ibc"), seed=0)
    batch: Batch = pairs.batch(torch.arange(6))
    chance = ours.draw(batch.actions, generator=torch.Generator().manual_seed(0))
    expected = torch.log(torch.tensor(1025.0)).item()
    assert ours.loss(batch, chance, weights=None).item() == pytest.approx(expected, abs=0.05)


@pytest.mark.parametrize(("precision", "tolerance"), [("float32", 1e-5), ("bfloat16", 1e-3)])
def test_both_losses_agree_on_the_same_weights_and_negatives_at_the_size_that_is_timed(
    precision: str, tolerance: float, pairs: PackedDemonstrations
) -> None:
    """128 x 1024 negatives; energies are made steep, so that the loss is not the log of their number."""
    config = presets.preset("paper", "da-ibc")
    ours = build_learner(config, seed=0)
    assert isinstance(ours, IbcLearner)
    with torch.no_grad():
        ours.energy.first.weight[:, -2:] *= 16
        ours.energy.last.weight *= 30
    theirs = NaiveLoop(pairs, batch_size=NUM, num_negatives=config.negatives.count)
    parts = (ours.encoder.image, ours.encoder.state, ours.encoder.joint)
    layers = (ours.energy.first, ours.energy.second, ours.energy.last)
    naive = theirs._encoder
    for own, other in zip(parts, (naive.image, naive.state, naive.joint), strict=True):
        other.load_state_dict(own.state_dict())
    for own, other in zip(layers, theirs._head[::2], strict=True):
        other.load_state_dict(own.state_dict())
    batch = pairs.batch(torch.arange(128) % NUM)
    chance = ours.draw(batch.actions, generator=torch.Generator().manual_seed(0))
    assert chance.negatives is not None
    assert chance.negatives.shape == (128, 1024, 2)
    with torch.autocast("cpu", torch.bfloat16, enabled=precision == "bfloat16"):
        loss = ours.loss(batch, chance, weights=None)
    state = batch.state * ours.encoder.state_scale
    with torch.no_grad():
        expected = theirs._contrast(naive(batch.bev, state), batch.actions, chance.negatives)
    assert abs(expected.item() - math.log(1025)) > 0.1
    assert loss.item() == pytest.approx(expected.item(), rel=tolerance)


def test_a_comparison_counts_the_steps_of_a_round(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(training, "STEPS", 1)
    row = training.compare("bc-beta", Plan(tmp_path, quick=True))
    assert row.pieces == 1
    assert len(row.our_rounds) == 2
    assert row.ratio.median > 0


def test_the_peak_is_at_least_what_was_held() -> None:
    before = memory.peak_bytes()
    assert before > 50e6
    held = torch.ones(40_000_000)  # 160 MB
    assert memory.peak_bytes() >= before
    assert memory.peak_bytes() > held.nbytes


def test_carried_demonstrations_are_read_back_as_a_data_set(tmp_path: Path) -> None:
    carried.write_dataset(tmp_path, NUM)
    manifest, episodes = dataset.read_dataset(tmp_path)
    assert manifest.town == carried.TOWN
    assert sum(len(episode.time) for episode in episodes) == NUM


def test_memory_is_that_of_a_run_that_was_read_and_written(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(memory, "QUICK_SAMPLES", NUM)
    monkeypatch.setattr(memory, "METHODS", ("bc-beta",))
    (row,) = memory.measure(Plan(tmp_path, quick=True))
    assert isinstance(row, Figure)
    assert f"on {NUM} samples" in row.work
    assert 0.1 < row.value.median < 3
    assert runs.is_run(tmp_path / "memory-bc-beta")


def test_a_training_that_fails_says_why_and_shows_no_traceback(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match="does not exist") as refusal:
        memory.peak_of_training("bc-beta", tmp_path / "none", tmp_path / "run")
    assert "Traceback" not in str(refusal.value)
