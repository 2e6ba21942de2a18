"""The search chooses as one that draws in any order, and as published code, does: two-sample tests on known energies."""

import dataclasses

import pytest
import torch
from torch import nn

from mjdrive.benchmarks.naive_dfo import NaiveDfo
from models import presets
from models.config import DfoConfig
from models.density import action_density
from models.learners import build_learner
from models.samplers import dfo
from models.samplers.draws import draw_categorical

NUM_SEARCHES = 1500
PAPER = DfoConfig(num_samples=128, start="uniform")


def fork(actions):
    """Two modes of unequal mass at steering +-0.4, over a low floor."""
    acceleration = (actions[..., 0] / 0.15).square()
    density = torch.full_like(acceleration, 1e-3)
    for steering, mass in ((0.4, 0.55), (-0.4, 0.45)):
        offset = ((actions[..., 1] - steering) / 0.15).square()
        density = density + mass * torch.exp(-0.5 * (acceleration + offset))
    return -density.log()


def chosen(config, generator):
    """What many searches of their own choose."""
    shape = (NUM_SEARCHES, config.num_samples, 2)
    start = 2 * torch.rand(shape, generator=generator) - 1
    return dfo.search(fork, start, config, generator=generator).actions


def p_value(one, two, generator, num_permutations=400):
    """Share of the ways to deal out both samples of equal size whose energy distance is as large as theirs.

    Reference:
        Szekely and Rizzo, Energy statistics: a class of statistics based on distances, 2013.
    """
    pooled = torch.cat((one, two))
    orders = [torch.randperm(len(pooled), generator=generator) for _ in range(num_permutations)]
    signs = torch.ones(1 + num_permutations, len(pooled))
    signs[0, len(one) :] = -1
    for row, order in zip(signs[1:], orders, strict=True):
        row[order[len(one) :]] = -1
    # Distances between the samples count positive, those within them negative.
    distances = -((signs @ torch.cdist(pooled, pooled)) * signs).sum(dim=1)
    return (distances >= distances[0]).float().mean().item()


@pytest.mark.parametrize(
    "changes",
    [{}, {"choice": "argmin"}, {"temper": True}],
    ids=["paper", "argmin", "tempered"],
)
def test_searches_choose_alike_however_they_resample(changes, generator, monkeypatch):
    config = dataclasses.replace(PAPER, **changes)
    new = chosen(config, generator)
    monkeypatch.setattr(dfo, "draw_ascending", draw_categorical)
    old = chosen(config, generator)
    assert p_value(new, old, generator) > 0.01


def test_the_two_sample_test_tells_two_passes_less_apart(generator):
    other = dataclasses.replace(PAPER, iterations=3)
    assert p_value(chosen(PAPER, generator), chosen(other, generator), generator) < 0.01


class Nothing(nn.Module):
    """Stands in for the encoder: the energy hangs on the action alone."""

    def forward(self, bev, state):
        return torch.zeros(len(bev), 256)


def learner_at_fork(precision="float32", **changes):
    """A learner whose network is E = 8 | |s| - 0.4 | + 8 |a| + 0.5 max(s, 0) for acceleration a and steering s.

    Its expert actions crowd at one corner, so that starts by the density and by its inverse differ.
    """
    config = presets.paper("da-ibc")
    changes = {"num_samples": 64, "start": "inverse_kde"} | changes
    search = dataclasses.replace(config.sampler.dfo, **changes)
    sampler = dataclasses.replace(config.sampler, kind="dfo", dfo=search, precision=precision)
    learner = build_learner(dataclasses.replace(config, sampler=sampler), seed=0).eval()
    learner.encoder, head = Nothing(), learner.energy
    with torch.no_grad():
        for parameter in head.parameters():
            parameter.zero_()
        head.first.weight[:4, -2:] = torch.tensor([[0, 1], [0, -1], [1, 0], [-1, 0]])
        # | |s| - 0.4 | from both sides, |a|, and max(s, 0).
        head.second.weight[0, :2], head.second.bias[0] = 1, -0.4
        head.second.weight[1, :2], head.second.bias[1] = -1, 0.4
        head.second.weight[2, 2:4] = 1
        head.second.weight[3, 0] = 1
        head.last.weight[0, :4] = torch.tensor([8.0, 8.0, 8.0, 0.5])
    unit = torch.rand(400, 2, generator=torch.Generator().manual_seed(5))
    actions = 2 * unit.square() - 1
    learner.prepare(actions, action_density(actions, config.density))
    return learner


def ours_and_theirs(learner, naive, generator, num=150):
    bev, state = torch.zeros(num, 1, 1, 1, dtype=torch.uint8), torch.zeros(num, 3)
    ours = learner.act(bev, state, generator=generator)
    theirs = [naive.act(bev[:1], state[:1], generator=generator) for _ in range(num)]
    return ours, torch.cat(theirs)


@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
@pytest.mark.parametrize("iterations", [1, 5])
def test_the_search_from_expert_actions_chooses_as_published_code_does(
    iterations, precision, generator
):
    """With one pass, what is chosen is a start."""
    learner = learner_at_fork(precision, iterations=iterations)
    naive = NaiveDfo(learner, encodes_once=True)
    assert p_value(*ours_and_theirs(learner, naive, generator), generator) > 0.01


def test_the_two_sample_test_tells_another_start_apart(generator):
    learner = learner_at_fork(iterations=1, start="kde")
    naive = NaiveDfo(learner_at_fork(iterations=1), encodes_once=True)
    assert p_value(*ours_and_theirs(learner, naive, generator), generator) < 0.01


def test_the_known_energy_is_what_its_weights_say():
    actions = torch.tensor([[[0.0, 0.4], [0.0, -0.4], [0.5, 0.0], [-0.25, 1.0]]])
    energies = learner_at_fork().energies(
        torch.zeros(1, 1, 1, 1, dtype=torch.uint8), torch.zeros(1, 3), actions
    )
    torch.testing.assert_close(energies, torch.tensor([[0.2, 0.0, 7.2, 7.3]]))
