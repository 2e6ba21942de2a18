import dataclasses
import math

import pytest
import torch

from models import negatives
from models.config import NegativesConfig
from models.errors import SettingError
from models.negatives import (
    log_density,
    mixed_negatives,
    perturbed_expert_negatives,
    uniform_actions,
)

EXPERTS = torch.tensor([[-0.5, 0.0], [0.25, 0.5]])
CONFIG = NegativesConfig(count=400, sigma=0.0)


def test_uniform_actions_fill_the_box_evenly(generator):
    actions = uniform_actions(50, 400, generator=generator)
    assert actions.shape == (50, 400, 2)
    assert actions.abs().max() <= 1
    assert actions.mean().item() == pytest.approx(0, abs=0.02)
    assert actions.var().item() == pytest.approx(1 / 3, abs=0.01)


def test_without_noise_negatives_are_expert_actions_drawn_evenly(generator):
    drawn = mixed_negatives(EXPERTS, 20, CONFIG, generator=generator)
    is_first = (drawn == EXPERTS[0]).all(dim=-1)
    assert (is_first | (drawn == EXPERTS[1]).all(dim=-1)).all()
    assert is_first.float().mean().item() == pytest.approx(0.5, abs=0.03)


def test_noise_has_the_standard_deviation_of_the_settings(generator):
    drawn = perturbed_expert_negatives(
        torch.zeros(1, 2), 50, 400, sigma=0.2, clip=False, generator=generator
    )
    assert drawn.std(dim=(0, 1)).tolist() == pytest.approx([0.2, 0.2], abs=0.005)


@pytest.mark.parametrize("clip", [True, False])
def test_clipping_brings_negatives_into_the_box(clip, generator):
    config = dataclasses.replace(CONFIG, sigma=1.0, clip=clip)
    drawn = mixed_negatives(EXPERTS, 20, config, generator=generator)
    assert (drawn.abs().max() <= 1) == clip


def test_the_uniform_share_is_exact(generator):
    config = dataclasses.replace(CONFIG, uniform_share=0.25)
    drawn = mixed_negatives(EXPERTS, 3, config, generator=generator)
    is_expert = (drawn[:, :, None] == EXPERTS).all(dim=-1).any(dim=-1)
    assert is_expert.sum(dim=1).tolist() == [300] * 3


def test_observations_get_different_negatives(generator):
    config = dataclasses.replace(CONFIG, sigma=0.1)
    first, second = mixed_negatives(EXPERTS, 2, config, generator=generator)
    assert not torch.equal(first, second)


def test_density_of_negatives_integrates_to_one_and_is_the_one_drawn_from():
    experts = torch.tensor([[-0.8, 0.0], [0.3, 0.4], [0.3, -0.4]])
    config = NegativesConfig(
        count=400, sigma=0.2, clip=False, uniform_share=0.25, correction="ranking"
    )
    axis = torch.linspace(-2.5, 2.5, 201)
    cell = float(axis[1] - axis[0]) ** 2
    grid = torch.cartesian_prod(axis, axis)
    density = log_density(grid[None], experts, config).exp()[0]
    assert float(density.sum()) * cell == pytest.approx(1.0, abs=0.03)
    drawn = mixed_negatives(experts, 500, config, generator=torch.Generator().manual_seed(0))
    right = (drawn[..., 0] > 0.05).float().mean()
    assert float(right) == pytest.approx(float(density[grid[:, 0] > 0.05].sum()) * cell, abs=0.02)


@pytest.mark.parametrize("uniform_share", [0.0, 0.5])
@pytest.mark.parametrize("sigma", [0.05, 0.2])
def test_density_in_parts_equals_the_plain_formula_in_double_precision(
    sigma, uniform_share, generator, monkeypatch
):
    experts = uniform_actions(1, 40, generator=generator)[0]
    actions = 1.5 * uniform_actions(3, 100, generator=generator)
    config = NegativesConfig(
        count=10, sigma=sigma, clip=False, uniform_share=uniform_share, correction="ranking"
    )
    exact, centers = actions.double(), experts.double()
    squared = (exact[:, :, None] - centers).square().sum(dim=-1)
    density = (-0.5 * squared / sigma**2).exp().mean(dim=-1) / (2 * math.pi * sigma**2)
    inside = (exact.abs() <= 1).all(dim=-1)
    expected = ((1 - uniform_share) * density + uniform_share * inside / 4).log()
    monkeypatch.setitem(negatives.PAIRS_AT_A_TIME, "cpu", 40 * 7)
    found = log_density(actions, experts, config)
    is_normal = expected > -80  # beyond, single precision has no such density, only its log
    torch.testing.assert_close(found[is_normal], expected[is_normal].float(), rtol=1e-5, atol=2e-4)
    assert torch.isfinite(found[inside]).all()


def test_ranking_correction_learns_the_density_itself_and_none_its_ratio():
    # One observation, two actions, the first three times as frequent; negatives follow the experts.
    # -E + log p_n of the optimum is log p + constant, so the correction must add log p_n exactly once.
    experts = torch.tensor([[0.5, 0.0]] * 3 + [[-0.5, 0.0]])
    config = NegativesConfig(sigma=0.1, clip=False, correction="ranking")
    log_p = log_density(torch.tensor([[[0.5, 0.0], [-0.5, 0.0]]]), experts, config)[0]
    assert float(log_p[0] - log_p[1]) == pytest.approx(math.log(3.0), abs=1e-4)


def test_density_of_clipped_negatives_is_refused():
    with pytest.raises(SettingError, match="correction is 'ranking'"):
        NegativesConfig(clip=True, correction="ranking")
