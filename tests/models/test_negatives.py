import dataclasses

import pytest
import torch

from models.config import NegativesConfig
from models.negatives import mixed_negatives, perturbed_expert_negatives, uniform_actions

EXPERTS = torch.tensor([[-0.5, 0.0], [0.25, 0.5]])
CONFIG = NegativesConfig(count=400, sigma=0.0)


def test_uniform_actions_fill_the_box_evenly(generator):
    actions = uniform_actions(50, 400, generator=generator)
    assert actions.shape == (50, 400, 2)
    assert actions.abs().max() <= 1
    assert actions.mean().item() == pytest.approx(0, abs=0.02)
    assert actions.var().item() == pytest.approx(1 / 3, abs=0.01)


def test_without_noise_negatives_are_expert_actions_drawn_evenly(generator):
    negatives = mixed_negatives(EXPERTS, 20, CONFIG, generator=generator)
    is_first = (negatives == EXPERTS[0]).all(dim=-1)
    assert (is_first | (negatives == EXPERTS[1]).all(dim=-1)).all()
    assert is_first.float().mean().item() == pytest.approx(0.5, abs=0.03)


def test_noise_has_the_standard_deviation_of_the_settings(generator):
    negatives = perturbed_expert_negatives(
        torch.zeros(1, 2), 50, 400, sigma=0.2, clip=False, generator=generator
    )
    assert negatives.std(dim=(0, 1)).tolist() == pytest.approx([0.2, 0.2], abs=0.005)


@pytest.mark.parametrize("clip", [True, False])
def test_clipping_brings_negatives_into_the_box(clip, generator):
    config = dataclasses.replace(CONFIG, sigma=1.0, clip=clip)
    negatives = mixed_negatives(EXPERTS, 20, config, generator=generator)
    assert (negatives.abs().max() <= 1) == clip


def test_the_uniform_share_is_exact(generator):
    config = dataclasses.replace(CONFIG, uniform_share=0.25)
    negatives = mixed_negatives(EXPERTS, 3, config, generator=generator)
    is_expert = (negatives[:, :, None] == EXPERTS).all(dim=-1).any(dim=-1)
    assert is_expert.sum(dim=1).tolist() == [300] * 3


def test_observations_get_different_negatives(generator):
    config = dataclasses.replace(CONFIG, sigma=0.1)
    first, second = mixed_negatives(EXPERTS, 2, config, generator=generator)
    assert not torch.equal(first, second)
