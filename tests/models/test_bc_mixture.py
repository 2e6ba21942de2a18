import dataclasses
import math

import pytest
import torch
from torch import nn
from torch.distributions import Beta

from models.bc_mixture import (
    LEAST_CONCENTRATION,
    BcMixtureLearner,
    mixture_log_prob,
    mixture_mode,
    squareplus,
)
from models.config import CommitmentConfig, LearnerConfig
from models.errors import SettingError
from models.samplers.commitment import Commitment

# Two ways at a junction: to the left with 0.65, to the right with 0.35; acceleration and steering in [0, 1].
SHARES = torch.tensor([0.65, 0.35])
ALPHA = torch.tensor([[12.0, 30.0], [12.0, 10.0]])
BETA = torch.tensor([[8.0, 10.0], [8.0, 30.0]])


def known_mixture():
    return SHARES.log()[None], Beta(ALPHA[None], BETA[None])


class KnownJunction:
    """The same density as a source of expert actions in [-1, 1], for `train_at_fork`."""

    def __init__(self, fork):
        self.fork = fork

    def batch(self, num, generator):
        which = (torch.rand(num, generator=generator) >= SHARES[0]).long()
        torch.manual_seed(int(torch.randint(2**40, (), generator=generator)))
        actions = 2 * Beta(ALPHA, BETA).sample((num,))[torch.arange(num), which] - 1
        return self.fork.batch(num, generator)._replace(actions=actions)


@pytest.fixture(scope="module")
def trained(small_config, train_at_fork, fork):
    config = small_config("bc-mixture")
    config = dataclasses.replace(
        config,
        beta=dataclasses.replace(config.beta, label_noise=0.0),
        mixture=dataclasses.replace(config.mixture, components=2),
    )
    return train_at_fork(config, KnownJunction(fork), steps=400, rate=0.02)


def test_training_recovers_the_shares_and_moments_of_a_known_mixture(trained, fork):
    log_weights, components = trained.mixture(*fork.unseen(1))
    left = int(components.mean[0, :, 1].argmax())
    order = [left, 1 - left]
    torch.testing.assert_close(log_weights[0, order].exp(), SHARES, rtol=0, atol=0.04)
    known = Beta(ALPHA, BETA)
    torch.testing.assert_close(components.mean[0, order], known.mean, rtol=0, atol=0.02)
    torch.testing.assert_close(components.stddev[0, order], known.stddev, rtol=0.15, atol=0)


def test_samples_keep_both_sides_and_mode_and_mean_are_what_they_say(trained, fork, generator):
    config = trained.config
    found = {}
    for inference in ("sample", "mode", "mean"):
        trained.config = dataclasses.replace(
            config, beta=dataclasses.replace(config.beta, inference=inference)
        )
        found[inference] = trained.act(*fork.unseen(3000), generator=generator)
    trained.config = config
    left = (found["sample"][:, 1] > 0).float().mean()
    assert float(left) == pytest.approx(0.65, abs=0.05)
    mean = 2 * (SHARES[:, None] * ALPHA / (ALPHA + BETA)).sum(dim=0) - 1
    torch.testing.assert_close(found["mean"][0], mean, rtol=0, atol=0.05)
    log_weights, components = known_mixture()
    mode = 2 * mixture_mode(log_weights, components, 1e-3)[0] - 1
    torch.testing.assert_close(found["mode"][0], mode, rtol=0, atol=0.05)


def test_lasting_chance_keeps_its_side_and_every_moment_its_distribution(
    trained, fork, generator, monkeypatch
):
    sampling = dataclasses.replace(trained.config.beta, inference="sample")
    monkeypatch.setattr(trained, "config", dataclasses.replace(trained.config, beta=sampling))
    num_drivers = 400
    config = CommitmentConfig(hold=10**9, release=1.0)
    commitment = Commitment(config, num_drivers, generator=generator)
    seen = fork.unseen(num_drivers)
    first, second = (
        trained.act(*seen, generator=generator, commitment=commitment) for _ in range(2)
    )
    torch.testing.assert_close(first[:, 1], second[:, 1], rtol=0, atol=2 / 128)  # a cell
    assert not torch.equal(first[:, 0], second[:, 0])
    with torch.no_grad():
        log_weights, components = trained.mixture(*fork.unseen(1))
    for side, component in ((1, 0), (-1, 1)):
        order = components.mean[0, :, 1].argsort(descending=True)
        here = first[side * first[:, 1] > 0]
        share = log_weights.exp()[0, order[component]]
        assert len(here) / num_drivers == pytest.approx(float(share), abs=0.06)
        mean, deviation = (it[0, order[component]] for it in (components.mean, components.stddev))
        torch.testing.assert_close(here.mean(dim=0), 2 * mean - 1, rtol=0, atol=0.07)
        torch.testing.assert_close(here.std(dim=0), 2 * deviation, rtol=0.2, atol=0)


def test_the_mode_is_where_the_mixture_is_densest():
    log_weights, components = known_mixture()
    axis = torch.linspace(0.005, 0.995, 199)
    grid = torch.cartesian_prod(axis, axis)
    densest = grid[mixture_log_prob(log_weights, components, grid[None])[0].argmax()]
    mode = mixture_mode(log_weights, components, 1e-3)[0]
    torch.testing.assert_close(mode, densest, rtol=0, atol=0.01)


def test_the_density_integrates_to_one(trained, fork):
    axis = torch.linspace(-1, 1, 129)[1:] - 1 / 128
    cells = torch.cartesian_prod(axis, axis)[None]
    mass = float(trained.log_density(*fork.unseen(1), cells).exp().sum()) * (2 / 128) ** 2
    assert mass == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("beta_offset", [0, 1])
@pytest.mark.parametrize("num", [1, 5, 12])
def test_components_start_apart_and_hardly_sharper_than_they_may_be(
    beta_offset, num, small_config, fork
):
    learner = without_encoder(small_config("bc-mixture"), num, beta_offset=beta_offset)
    _, components = learner.mixture(*fork.unseen(1))
    distances = torch.cdist(components.mean[0], components.mean[0]) + torch.eye(num)
    assert float(distances.min().detach()) > 0.1
    total = components.concentration1 + components.concentration0
    torch.testing.assert_close(total, torch.full_like(total, LEAST_CONCENTRATION + 1))


@pytest.mark.parametrize("beta_offset", [0, 1])
def test_a_component_that_became_as_broad_as_it_can_learns_again(beta_offset, small_config, fork):
    """With concentrations that are softplus of what the network says, it would stay uniform: a slope of e^-30."""
    learner = without_encoder(small_config("bc-mixture"), 1, beta_offset=beta_offset)
    with torch.no_grad():
        learner.sharpness.bias.fill_(-30.0)
    _, before = learner.mixture(*fork.unseen(1))
    assert float(before.stddev.detach().max()) < 0.21
    label = torch.tensor([0.35, 0.5])  # braking
    biases = [learner.peaks.bias, learner.sharpness.bias]
    optimiser = torch.optim.Adam(biases, lr=2.0)
    schedule = torch.optim.lr_scheduler.ExponentialLR(optimiser, 0.995)
    noisy = label + 0.05 * torch.randn(1, 4096, 2)
    for _ in range(1000):
        optimiser.zero_grad()
        log_weights, components = learner.mixture(*fork.unseen(1))
        (-mixture_log_prob(log_weights, components, noisy).mean()).backward()
        optimiser.step()
        schedule.step()
    _, after = learner.mixture(*fork.unseen(1))
    torch.testing.assert_close(after.mean[0, 0], label, rtol=0, atol=0.01)
    torch.testing.assert_close(after.stddev[0, 0], torch.full((2,), 0.05), rtol=0.1, atol=0)


def test_squareplus_is_softplus_with_a_tail_that_still_slopes():
    raw = torch.tensor([-1e4, -25.0, -1.0, 0.0, 1.0, 25.0, 1e4], requires_grad=True)
    squareplus(raw).sum().backward()
    precise = raw.detach().double()
    root = torch.sqrt(precise**2 + 4)
    torch.testing.assert_close(squareplus(raw).double(), (precise + root) / 2, rtol=1e-5, atol=0)
    torch.testing.assert_close(raw.grad.double(), (1 + precise / root) / 2, rtol=1e-3, atol=1e-9)
    assert float(raw.grad[1]) > 1e-3


def without_encoder(config, num, *, beta_offset):
    """A mixture that sees nothing, so that the biases of its last layers are all it says."""
    config = dataclasses.replace(
        config,
        beta=dataclasses.replace(config.beta, beta_offset=beta_offset),
        mixture=dataclasses.replace(config.mixture, components=num),
    )
    torch.manual_seed(0)
    learner = BcMixtureLearner(config)
    learner.encoder = nn.Flatten()
    learner.head = nn.Identity()
    learner.encoder.forward = lambda bev, state: torch.zeros(1, 256)
    return learner


def test_an_entropy_bonus_is_refused(small_config):
    config = small_config("bc-mixture")
    bonus = dataclasses.replace(config.beta, entropy_bonus=0.01)
    with pytest.raises(SettingError, match=r"entropy_bonus is 0.01; expected 0 for bc-mixture"):
        dataclasses.replace(config, beta=bonus)
    assert LearnerConfig("bc-beta", beta=bonus).beta.entropy_bonus == 0.01


def test_one_component_is_a_beta():
    alpha, beta = torch.tensor([[[3.0, 5.0]]]), torch.tensor([[[2.0, 9.0]]])
    unit = torch.tensor([[[0.3, 0.6]]])
    found = mixture_log_prob(torch.zeros(1, 1), Beta(alpha, beta), unit)
    assert float(found) == pytest.approx(float(Beta(alpha, beta).log_prob(unit).sum()))
    assert math.isfinite(float(found))
