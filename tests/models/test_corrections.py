"""A junction whose shares are known: what each way to train makes of them, and what each correction gives back.

Nine of ten demonstrations keep the lane; the tenth is at a junction and goes left, straight on or right in the shares 0.40,
0.20 and 0.40. Straight on is what everybody does elsewhere, so whatever hangs on how common an action is tilts it.
"""

import dataclasses

import pytest
import torch
from torch import nn

from models import ibc
from models.config import (
    DensityConfig,
    LearnerConfig,
    NegativesConfig,
    NetworkConfig,
    SamplerConfig,
)
from models.density import action_density, inverse_weights, kernel_density
from models.interfaces import Batch
from models.learners import build_learner
from models.negatives import log_density
from models.samplers.draws import draw_categorical
from models.samplers.grid import action_grid

STRAIGHT = 1
STEERING = torch.tensor([0.45, 0.0, -0.45])
SPREAD = torch.tensor([0.05, 0.03, 0.05])
TRUE_SHARES = torch.tensor([0.40, 0.20, 0.40])
ACCELERATION, ACCELERATION_SPREAD = 0.1, 0.1
JUNCTION_SHARE = 0.1
NUM_DEMONSTRATIONS = 2000
STEPS, BATCH_SIZE, LEARNING_RATE = 120, 64, 4e-3
GRID = action_grid(65)


class Constant(nn.Module):
    """Stands in for the encoder: every observation is the junction."""

    feature_size = 256

    def forward(self, bev, state):
        return torch.full((len(bev), self.feature_size), 0.05)


@pytest.fixture(scope="module")
def demonstrated():
    """Actions of all demonstrations, those at the junction first."""
    generator = torch.Generator().manual_seed(0)
    num_junction = int(JUNCTION_SHARE * NUM_DEMONSTRATIONS)
    turns = torch.repeat_interleave(torch.arange(3), (num_junction * TRUE_SHARES).round().long())
    keeps = torch.full((NUM_DEMONSTRATIONS - num_junction,), STRAIGHT)
    modes = torch.cat((turns, keeps))
    noise = torch.randn(2, NUM_DEMONSTRATIONS, generator=generator)
    acceleration = ACCELERATION + ACCELERATION_SPREAD * noise[0]
    return torch.stack((acceleration, STEERING[modes] + SPREAD[modes] * noise[1]), dim=1)


def true_log_density(actions):
    """Of actions at the junction, up to a constant [nats]."""
    acceleration = -0.5 * ((actions[..., 0] - ACCELERATION) / ACCELERATION_SPREAD).square()
    offsets = (actions[..., 1, None] - STEERING) / SPREAD
    steering = ((TRUE_SHARES / SPREAD).log() - 0.5 * offsets.square()).logsumexp(dim=-1)
    return acceleration + steering


def settings(method, weighting, correction, undo="none"):
    return LearnerConfig(
        method,
        network=NetworkConfig(action_gain=16.0),
        negatives=NegativesConfig(count=16, sigma=0.1, clip=False, correction=correction),
        density=DensityConfig(bandwidth=0.2, weighting=weighting),
        sampler=SamplerConfig(kind="grid", undo=undo),
    )


def learner_for(config, demonstrated):
    learner = build_learner(config, seed=0)
    learner.encoder = Constant()
    learner.prepare(demonstrated, action_density(demonstrated, config.density))
    return learner


def views(num):
    return torch.zeros(num, 1, 1, 1, dtype=torch.uint8), torch.zeros(num, 3)


def best_energy(config, demonstrated):
    """What training without end leads to: -E = log p(y | x) + log w(y) - log p_n(y)."""
    weighting = config.density
    learnt = true_log_density(GRID)
    if weighting.weighting != "none":
        there = kernel_density(
            GRID, demonstrated, bandwidth=weighting.bandwidth, kind=weighting.kind
        )
        learnt = learnt + inverse_weights(there, weighting).log()
    if config.method == "da-ibc" and config.negatives.correction == "none":
        pool = demonstrated
        if weighting.weighting == "sampler":
            weights = inverse_weights(action_density(demonstrated, weighting), weighting)
            drawn = draw_categorical(
                weights[None], 8000, generator=torch.Generator().manual_seed(1)
            )
            pool = demonstrated[drawn[0]]
        learnt = learnt - log_density(GRID[None], pool, config.negatives)[0]
    return -learnt


def steering_shares(steering, mass):
    """Mass of the three ways."""
    ways = steering > 0.2, steering.abs() <= 0.2, steering < -0.2
    return [float((mass * way).sum()) for way in ways]


def shares(learner):
    """What the learner says of the three ways at the junction."""
    said = learner.log_density(*views(1), GRID[None])[0]
    return steering_shares(GRID[:, 1], torch.softmax(said, dim=0))


UNTILTED = (0.40, 0.20, 0.40)


@pytest.mark.parametrize(
    ("trained", "undo", "expected"),
    [
        (("ibc", "none", "none"), "none", UNTILTED),
        (("ibc", "sampler", "none"), "none", (0.485, 0.029, 0.485)),
        (("ibc", "loss", "none"), "none", (0.485, 0.029, 0.485)),
        (("ibc", "sampler", "none"), "density", UNTILTED),
        (("ibc", "loss", "none"), "density", UNTILTED),
        (("da-ibc", "none", "none"), "none", (0.495, 0.010, 0.495)),
        (("da-ibc", "none", "ranking"), "none", UNTILTED),
        (("da-ibc", "none", "none"), "negatives", UNTILTED),
        (("da-ibc", "sampler", "none"), "none", (0.495, 0.009, 0.495)),
        (("da-ibc", "sampler", "none"), "negatives", (0.485, 0.029, 0.485)),
        (("da-ibc", "sampler", "ranking"), "none", (0.485, 0.029, 0.485)),
        (("da-ibc", "sampler", "ranking"), "density", UNTILTED),
        (("da-ibc", "sampler", "none"), "both", UNTILTED),
        (("da-ibc", "loss", "none"), "both", UNTILTED),
    ],
)
def test_training_without_end_is_tilted_as_expected_and_corrections_give_the_shares_back(
    trained, undo, expected, demonstrated, monkeypatch
):
    config = settings(*trained, undo)
    learner = learner_for(config, demonstrated)
    energies = best_energy(config, demonstrated)
    monkeypatch.setattr(ibc, "EnergyScorer", lambda *_, **__: lambda _: energies[None])
    found = shares(learner)
    assert found[STRAIGHT] == pytest.approx(expected[STRAIGHT], abs=0.01)
    # How the demonstrations happened to fall tilts left against right a little.
    assert found == pytest.approx(expected, abs=0.02 if expected is UNTILTED else 0.05)


def test_driving_goes_by_the_shares_that_undoing_gives_back(demonstrated, generator, monkeypatch):
    config = settings("da-ibc", "sampler", "none", "both")
    energies = best_energy(config, demonstrated)
    monkeypatch.setattr(ibc, "GridScorer", lambda *_, **__: lambda _: energies.expand(1000, -1))
    for undo, expected in (("none", (0.495, 0.009, 0.495)), ("both", UNTILTED)):
        learner = learner_for(settings("da-ibc", "sampler", "none", undo), demonstrated)
        steering = learner.act(*views(1000), generator=generator)[:, 1]
        assert steering_shares(steering, 1 / 1000) == pytest.approx(expected, abs=0.04)


def trained_at_the_junction(config, demonstrated, generator):
    """A network that saw nothing but the junction; its negatives are what is done anywhere."""
    config = dataclasses.replace(
        config, negatives=dataclasses.replace(config.negatives, pool="dataset")
    )
    learner = learner_for(config, demonstrated)
    num_junction = int(JUNCTION_SHARE * NUM_DEMONSTRATIONS)
    optimiser = torch.optim.Adam(learner.energy.parameters(), lr=LEARNING_RATE)
    for step in range(STEPS):
        optimiser.param_groups[0]["lr"] = LEARNING_RATE * (1 - step / STEPS)
        rows = torch.randint(num_junction, (BATCH_SIZE,), generator=generator)
        batch = Batch(*views(BATCH_SIZE), demonstrated[rows])
        chance = learner.draw(batch.actions, generator=generator)
        optimiser.zero_grad()
        learner.loss(batch, chance, weights=None).backward()
        optimiser.step()
    return learner


def with_undo(learner, undo):
    sampler = dataclasses.replace(learner.config.sampler, undo=undo)
    learner.config = dataclasses.replace(learner.config, sampler=sampler)
    return learner


def test_a_trained_network_has_the_tilt_and_loses_it_by_undoing(demonstrated, generator):
    config = settings("da-ibc", "none", "none")
    learner = trained_at_the_junction(config, demonstrated, generator)
    assert shares(learner)[STRAIGHT] < 0.05
    assert shares(with_undo(learner, "negatives")) == pytest.approx(UNTILTED, abs=0.07)


def test_a_network_trained_with_ranking_has_no_tilt(demonstrated, generator):
    config = settings("da-ibc", "none", "ranking")
    learner = trained_at_the_junction(config, demonstrated, generator)
    assert shares(learner) == pytest.approx(UNTILTED, abs=0.07)
