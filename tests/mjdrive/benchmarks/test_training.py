from pathlib import Path

import pytest
import torch

from mjdrive.benchmarks import carried, memory, training
from mjdrive.benchmarks.comparison import Plan
from mjdrive.benchmarks.naive_training import NaiveLoop
from mjdrive.learning.batches import PackedDemonstrations
from models import presets
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
