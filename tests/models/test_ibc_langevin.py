import dataclasses

import pytest
import torch
from torch import nn

from models.config import ChainConfig, LangevinNegativesConfig, NegativesConfig
from models.contrast import info_nce
from models.ibc_langevin import LangevinIbcLearner, gradient_penalty
from models.interfaces import Batch
from models.samplers.langevin import step_sizes

CHAIN = ChainConfig(iterations=6, step_init=0.2)


class Constant(nn.Module):
    """Stands in for the encoder: every observation looks alike."""

    feature_size = 256

    def forward(self, bev, state):
        return torch.full((len(bev), self.feature_size), 0.05)


@pytest.fixture
def learner(small_config):
    config = small_config("ibc-langevin")
    config = dataclasses.replace(
        config,
        negatives=NegativesConfig(count=8, uniform_share=0.25),
        langevin_negatives=LangevinNegativesConfig(
            chain=CHAIN, penalty_weight=0.7, penalty_margin=0.02
        ),
    )
    torch.manual_seed(0)
    learner = LangevinIbcLearner(config)
    learner.encoder = Constant()
    return learner


@pytest.fixture
def looks_alike(batch):
    num = len(batch.actions)
    return Batch(torch.zeros(num, 1, 1, 1, dtype=torch.uint8), torch.zeros(num, 3), batch.actions)


def energies_and_slopes(learner, batch, actions):
    """By autograd, so that slopes have gradients of their own."""
    actions = actions.detach().clone().requires_grad_()
    energies = learner.energy(learner.encoder(batch.bev, batch.state), actions)
    return energies, torch.autograd.grad(energies.sum(), actions, create_graph=True)[0]


def plain_loss(learner, batch, chance):
    """The loss as one writes it first: chains, InfoNCE and penalty, all by autograd."""
    actions, still = chance.negatives[:, 2:], chance.negatives[:, :2]
    for index, size in enumerate(step_sizes(CHAIN)):
        _, slopes = energies_and_slopes(learner, batch, actions)
        change = (size * chance.chain_noise[:, index] - 0.5 * size * slopes).clamp(-0.1, 0.1)
        actions = (actions + change).clamp(-1, 1).detach()
    candidates = torch.cat((batch.actions[:, None], still, actions), dim=1)
    energies, slopes = energies_and_slopes(learner, batch, candidates)
    excess = (slopes.abs().max(dim=-1).values - 0.02).clamp(min=0)
    return info_nce(energies[:, 0], energies[:, 1:]).mean() + 0.7 * excess.square().mean()


def test_loss_and_gradients_are_those_of_plain_chains_by_autograd(learner, looks_alike, generator):
    chance = learner.draw(looks_alike.actions, generator=generator)
    parameters = {
        # The last bias moves no slope and the softmax cancels it.
        name: it
        for name, it in learner.energy.named_parameters()
        if name != "last.bias"
    }
    losses = (
        learner.loss(looks_alike, chance, weights=None),
        plain_loss(learner, looks_alike, chance),
    )
    torch.testing.assert_close(*losses)
    found, expected = (torch.autograd.grad(loss, parameters.values()) for loss in losses)
    for name, one, other in zip(parameters, found, expected, strict=True):
        torch.testing.assert_close(one, other, rtol=1e-3, atol=1e-6, msg=name)


def test_the_penalty_is_the_closed_form_above_its_margin_and_nothing_below():
    slopes = torch.tensor([[[3.0, -0.5], [0.2, -4.0]], [[0.9, 0.1], [-1.0, 1.0]]])
    expected = torch.tensor([((3 - 1) ** 2 + (4 - 1) ** 2) / 2, 0.0])
    torch.testing.assert_close(gradient_penalty(slopes, margin=1.0), expected)


def test_chains_are_as_exact_under_autocast(learner, looks_alike, generator):
    chance = learner.draw(looks_alike.actions, generator=generator)
    plain = learner.loss(looks_alike, chance, weights=None)
    with torch.autocast("cpu", torch.bfloat16):
        rounded = learner.loss(looks_alike, chance, weights=None)
    torch.testing.assert_close(rounded, plain, rtol=0, atol=0.02)


def test_the_uniform_share_does_not_walk(learner, looks_alike, generator):
    chance = learner.draw(looks_alike.actions, generator=generator)
    assert chance.chain_noise.shape == (10, 6, 6, 2)
    features = learner.encoder(looks_alike.bev, looks_alike.state)
    walked = learner._walked(features, chance)
    assert torch.equal(walked[:, :2], chance.negatives[:, :2])
    assert not (walked[:, 2:] == chance.negatives[:, 2:]).any()
