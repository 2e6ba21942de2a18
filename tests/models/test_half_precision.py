import dataclasses

import pytest
import torch

from models import checkpoint
from models.bc_beta import BcBetaLearner
from models.checkpoint import RunState
from models.half_precision import WORTH_IT, halved, variations, widened
from models.learners import build_learner


def test_rounding_moves_a_weight_by_a_2048th_of_it_at_most():
    weights = {"a": torch.randn(WORTH_IT, generator=torch.Generator().manual_seed(0)) + 3.0}
    back = widened(halved(weights))["a"]
    assert back.dtype == torch.float32
    assert ((back - weights["a"]) / weights["a"]).abs().max() <= 2**-11
    assert not torch.equal(back, weights["a"])


def test_numbers_that_float16_has_survive_and_whole_numbers_are_left_alone():
    tensors = {
        "a": torch.tensor([0.5, -2.0, 65504.0, 0.0]).repeat(WORTH_IT // 4),
        "b": torch.tensor([2**40]),
    }
    halves = halved(tensors)
    assert (halves["a"].dtype, halves["b"].dtype) == (torch.float16, torch.int64)
    assert all(torch.equal(widened(halves)[name], tensors[name]) for name in tensors)


def test_what_float16_cannot_hold_is_not_halved():
    assert halved({"a": torch.full((WORTH_IT,), 1e6)}) is None


def test_small_tensors_stay_as_they_are():
    small = torch.full((WORTH_IT - 1,), 0.1)
    kept = halved({"bias": small})
    assert kept is not None
    assert torch.equal(kept["bias"], small)


@pytest.mark.parametrize("method", ["bc-beta", "da-ibc"])
def test_a_checkpoint_in_float16_is_read_as_the_same_numbers_in_float32(
    method, small_config, tmp_path
):
    learner = build_learner(small_config(method), seed=0)
    learner.prepare(torch.rand(5, 2), torch.rand(5))
    checkpoint.save(tmp_path, learner, RunState(method, seed=0, epoch=1, epochs=1))
    halves = halved(learner.state_dict())
    assert {tensor.dtype for tensor in halves.values()} == {torch.float16, torch.float32}
    checkpoint.write_tensors(tmp_path / checkpoint.MODEL, halves, epoch=1)
    loaded = checkpoint.load(tmp_path).state_dict()
    assert {tensor.dtype for tensor in loaded.values()} == {torch.float32}
    assert all(torch.equal(loaded[name], halves[name].float()) for name in halves)


def fixed_beta(small_config, *, alpha):
    """A policy that sees nothing: the acceleration is Beta(alpha, 1), the steering Beta(1, 1)."""
    config = small_config("bc-beta")
    beta = dataclasses.replace(config.beta, beta_offset=0)
    learner = BcBetaLearner(dataclasses.replace(config, beta=beta))
    for layer, values in ((learner.alpha, (alpha, 1.0)), (learner.beta, (1.0, 1.0))):
        torch.nn.init.zeros_(layer.weight)
        # softplus undone
        layer.bias.data = torch.tensor(values).expm1().log()
    return learner


def test_variation_is_that_of_the_closed_form(small_config, batch):
    # Densities 1 and 2 u on [0, 1] are the same at u = 1/2 and differ by 1/4 on either side.
    one, other = (fixed_beta(small_config, alpha=alpha) for alpha in (1.0, 2.0))
    found = variations(one, other, batch.bev[:2], batch.state[:2], points=65)
    assert found == pytest.approx([0.25, 0.25], abs=0.005)
    assert variations(one, one, batch.bev[:1], batch.state[:1]) == pytest.approx([0.0], abs=1e-12)


def test_densities_of_rare_actions_do_not_vanish() -> None:
    density = torch.tensor([1.0, 1.2e-8]).repeat(WORTH_IT // 2)
    kept = halved({"experts.density": density})
    assert kept is not None
    assert torch.equal(kept["experts.density"], density)
