import dataclasses

import pytest
import torch
from torch import nn

from models import ibc
from models.config import GridConfig, SamplerConfig
from models.da_ibc import DaIbcLearner
from models.density import action_density
from models.ibc import IbcLearner
from models.interfaces import Batch

STEERING = 0.4
SHARE_LEFT = 0.65


class Constant(nn.Module):
    """Stands in for the encoder: every observation is the same fork."""

    feature_size = 256

    def forward(self, bev, state):
        return torch.full((len(bev), self.feature_size), 0.05)


def unseen(num):
    """Observations that nothing looks at."""
    return torch.zeros(num, 1, 1, 1, dtype=torch.uint8), torch.zeros(num, 3)


def fork(num, generator):
    """Expert actions at a fork: 65 % left, 35 % right, never straight on."""
    left = torch.rand(num, generator=generator) < SHARE_LEFT
    steering = torch.where(left, STEERING, -STEERING)
    noise = 0.03 * torch.randn(num, 2, generator=generator)
    actions = torch.stack((torch.full_like(steering, 0.2), steering), dim=1) + noise
    return Batch(*unseen(num), actions)


def loss_of(learner, batch, generator, weights=None):
    """Loss with fresh draws."""
    chance = learner.draw(batch.actions, generator=generator)
    return learner.loss(batch, chance, weights=weights)


def train_at_fork(kind, config, generator):
    torch.manual_seed(0)
    learner = kind(config)
    learner.encoder = Constant()
    demonstrations = fork(2048, generator)
    learner.prepare(demonstrations.actions, action_density(demonstrations.actions, config.density))
    optimiser = torch.optim.Adam(learner.energy.parameters(), lr=2e-3)
    for step in range(200):
        optimiser.param_groups[0]["lr"] = 2e-3 * (1 - step / 200)
        batch = Batch(
            *(x[torch.randint(2048, (128,), generator=generator)] for x in demonstrations)
        )
        optimiser.zero_grad()
        loss_of(learner, batch, generator).backward()
        optimiser.step()
    return learner


@pytest.mark.parametrize("kind", [IbcLearner, DaIbcLearner])
def test_both_sides_of_a_fork_are_kept_and_the_middle_is_not(kind, small_config, generator):
    method = "ibc" if kind is IbcLearner else "da-ibc"
    config = small_config(method)
    config = dataclasses.replace(
        config,
        negatives=dataclasses.replace(config.negatives, count=16, uniform_share=0.5),
        sampler=SamplerConfig(kind="grid", grid=GridConfig(points=33)),
    )
    learner = train_at_fork(kind, config, generator)
    actions = learner.act(*unseen(300), generator=generator)
    steering = actions[:, 1]
    near = (steering.abs() - STEERING).abs() < 0.15
    assert near.float().mean() > 0.9
    assert 0.4 < (steering > 0).float().mean() < 0.9


def test_both_samplers_of_a_learner_choose_from_the_same_bowl(small_config, generator, monkeypatch):
    config = small_config("ibc")
    sampler = config.sampler
    config = dataclasses.replace(
        config,
        sampler=dataclasses.replace(
            sampler,
            kind="dfo",
            dfo=dataclasses.replace(sampler.dfo, choice="argmin", start="uniform"),
            grid=dataclasses.replace(sampler.grid, choice="argmin"),
        ),
    )
    learner = IbcLearner(config)
    learner.encoder = Constant()

    def bowl(actions):
        return 100 * (actions - torch.tensor([0.25, -0.5])).square().sum(dim=-1)

    for scorer in ("EnergyScorer", "GridScorer"):
        monkeypatch.setattr(ibc, scorer, lambda *_, **__: bowl)
    by_search = learner.act(*unseen(1), generator=generator)
    learner.config = dataclasses.replace(
        config, sampler=dataclasses.replace(config.sampler, kind="grid")
    )
    by_grid = learner.act(*unseen(1), generator=generator)
    torch.testing.assert_close(by_search, by_grid, rtol=0, atol=0.03)


@pytest.mark.parametrize("label", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("method", ["ibc", "da-ibc"])
def test_loss_and_gradient_are_finite_at_the_ends(method, label, small_config, generator):
    learner = {"ibc": IbcLearner, "da-ibc": DaIbcLearner}[method](small_config(method))
    batch = Batch(
        torch.zeros(2, 5, 192, 192, dtype=torch.uint8),
        torch.zeros(2, 3),
        torch.full((2, 2), label),
    )
    loss = loss_of(learner, batch, generator)
    loss.backward()
    assert torch.isfinite(loss)
    assert all(torch.isfinite(p.grad).all() for p in learner.parameters())
