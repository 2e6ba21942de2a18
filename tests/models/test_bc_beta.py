import dataclasses
import math

import pytest
import torch
from torch import nn
from torch.distributions import Beta

from models.bc_beta import BcBetaLearner
from models.config import CommitmentConfig
from models.interfaces import Batch
from models.samplers.commitment import Commitment


class Constant(nn.Module):
    """Stands in for the encoder: every observation looks alike."""

    feature_size = 256

    def forward(self, bev, state):
        return torch.ones(len(bev), self.feature_size)


@pytest.fixture
def constant_learner(small_config):
    def build(**beta):
        config = small_config("bc-beta")
        config = dataclasses.replace(config, beta=dataclasses.replace(config.beta, **beta))
        torch.manual_seed(0)
        learner = BcBetaLearner(config)
        learner.encoder = Constant()
        return learner

    return build


def loss_of(learner, batch, generator, weights=None):
    """Loss with fresh draws."""
    chance = learner.draw(batch.actions, generator=generator)
    return learner.loss(batch, chance, weights=weights)


def looks_alike(actions):
    num = len(actions)
    return Batch(torch.zeros(num, 1, 1, 1, dtype=torch.uint8), torch.zeros(num, 3), actions)


def test_training_recovers_known_beta_parameters(constant_learner, generator):
    alpha, beta = torch.tensor([2.0, 6.0]), torch.tensor([4.0, 3.0])
    torch.manual_seed(0)
    batch = looks_alike(2 * Beta(alpha, beta).sample((2000,)) - 1)
    learner = constant_learner(beta_offset=0)
    optimiser = torch.optim.Adam(learner.parameters(), lr=0.01)
    for _ in range(100):
        optimiser.zero_grad()
        loss_of(learner, batch, generator).backward()
        optimiser.step()
    found = learner.distribution(batch.bev[:1], batch.state[:1])
    torch.testing.assert_close(found.concentration1[0], alpha, rtol=0.1, atol=0)
    torch.testing.assert_close(found.concentration0[0], beta, rtol=0.1, atol=0)


@pytest.mark.parametrize("label", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("beta_offset", [0, 1])
@pytest.mark.parametrize("label_clamp", [1e-3, 1e-7])
def test_loss_and_gradient_are_finite_at_the_ends(
    constant_learner, label, beta_offset, label_clamp, generator
):
    learner = constant_learner(beta_offset=beta_offset, label_clamp=label_clamp, entropy_bonus=0.01)
    batch = looks_alike(torch.full((2, 2), label))
    loss = loss_of(learner, batch, generator)
    loss.backward()
    assert torch.isfinite(loss)
    assert all(torch.isfinite(p.grad).all() for p in learner.parameters())


def test_loss_is_finite_where_softplus_underflows(constant_learner, generator):
    learner = constant_learner(beta_offset=0)
    nn.init.constant_(learner.alpha.bias, -1000.0)
    loss = loss_of(learner, looks_alike(torch.zeros(2, 2)), generator)
    assert torch.isfinite(loss)


def test_weights_multiply_the_losses(constant_learner, generator):
    learner = constant_learner(label_noise=0.0)
    batch = looks_alike(torch.tensor([[0.5, 0.1], [-0.8, 0.9]]))
    single = [loss_of(learner, Batch(*(x[[i]] for x in batch)), generator) for i in range(2)]
    weighted = loss_of(learner, batch, generator, weights=torch.tensor([3.0, 1.0]))
    torch.testing.assert_close(weighted, (3 * single[0] + single[1]) / 2)


def test_samples_repeat_with_the_generator_and_have_the_mean_of_the_distribution(constant_learner):
    learner = constant_learner(inference="sample")
    batch = looks_alike(torch.zeros(500, 2))
    draws = [
        learner.act(batch.bev, batch.state, generator=torch.Generator().manual_seed(seed))
        for seed in (1, 1, 2)
    ]
    assert torch.equal(draws[0], draws[1])
    assert not torch.equal(draws[0], draws[2])
    mean = 2 * learner.distribution(batch.bev[:1], batch.state[:1]).mean[0] - 1
    torch.testing.assert_close(draws[0].mean(dim=0), mean, rtol=0, atol=0.1)


def test_label_noise_bounds_the_concentration_that_one_repeated_label_asks_for(constant_learner):
    labels = torch.zeros(256, 2)
    spread = {}
    for noise in (0.0, 0.2):
        learner = constant_learner(label_noise=noise, beta_offset=1)
        generator = torch.Generator().manual_seed(0)
        optimiser = torch.optim.Adam(learner.parameters(), 1e-2)
        for _ in range(150):
            optimiser.zero_grad()
            loss_of(learner, looks_alike(labels), generator).backward()
            optimiser.step()
        with torch.no_grad():
            spread[noise] = learner.distribution(*looks_alike(labels)[:2]).stddev
    # Noise of 0.2 in [-1, 1] is 0.1 in [0, 1].
    torch.testing.assert_close(spread[0.2][0], torch.full((2,), 0.1), atol=0.02, rtol=0.0)
    assert torch.all(spread[0.0] < 0.5 * spread[0.2])


def test_the_log_density_integrates_to_one_and_is_that_of_the_loss(constant_learner, generator):
    learner = constant_learner(label_noise=0.0)
    batch = looks_alike(torch.tensor([[0.3, -0.2], [-0.7, 0.5]]))
    centres = torch.linspace(-1, 1, 257)[1:] - 1 / 256
    cells = torch.cartesian_prod(centres, centres)[None]
    density = learner.log_density(batch.bev[:1], batch.state[:1], cells).exp()
    assert float(density.sum()) * (2 / 256) ** 2 == pytest.approx(1, abs=1e-3)
    own = learner.log_density(batch.bev, batch.state, batch.actions[:, None])
    # The loss speaks of actions rescaled to [0, 1], whose density is four times as high.
    expected = -loss_of(learner, batch, generator) - math.log(4)
    torch.testing.assert_close(own.mean(), expected)


def test_lasting_chance_keeps_steering_and_every_moment_its_distribution(
    constant_learner, generator
):
    learner = constant_learner(inference="sample", beta_offset=0)
    num_drivers = 2000
    seen = looks_alike(torch.zeros(num_drivers, 2))
    config = CommitmentConfig(hold=10**9, release=1.0)
    commitment = Commitment(config, num_drivers, generator=generator)
    first, second = (
        learner.act(seen.bev, seen.state, generator=generator, commitment=commitment)
        for _ in range(2)
    )
    torch.testing.assert_close(first[:, 1], second[:, 1], rtol=0, atol=2 / 128)  # a cell
    assert not torch.equal(first[:, 0], second[:, 0])
    known = learner.distribution(seen.bev[:1], seen.state[:1])
    torch.testing.assert_close(first.mean(dim=0), 2 * known.mean[0] - 1, rtol=0, atol=0.04)
    torch.testing.assert_close(first.std(dim=0), 2 * known.stddev[0], rtol=0.05, atol=0)
