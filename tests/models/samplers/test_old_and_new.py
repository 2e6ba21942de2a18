"""The search that draws in order chooses as the one that drew in any order did: two-sample tests on a known energy."""

import dataclasses

import pytest
import torch

from models.config import DfoConfig
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
