import dataclasses

import pytest
import torch

from models.cells import cell_areas, nearest_points
from models.samplers.grid import action_grid

POINTS = 9
TABLE = torch.zeros(POINTS, POINTS)
TABLE[2, 6], TABLE[2, 1], TABLE[0, 4] = 0.45, 0.25, 0.3


class KnownTable:
    """Expert actions that are grid points, drawn from a table; for `train_at_fork`."""

    def __init__(self, fork):
        self.fork = fork

    def batch(self, num, generator):
        drawn = torch.multinomial(TABLE.flatten(), num, replacement=True, generator=generator)
        return self.fork.batch(num, generator)._replace(actions=action_grid(POINTS)[drawn])


@pytest.fixture(scope="module")
def trained(small_config, train_at_fork, fork):
    config = small_config("bc-grid")
    settings = dataclasses.replace(config.categorical, points=POINTS, smoothing=0.0)
    config = dataclasses.replace(config, categorical=settings)
    return train_at_fork(config, KnownTable(fork), steps=120, rate=0.02)


def acting(learner, **categorical):
    settings = dataclasses.replace(learner.config.categorical, **categorical)
    learner.config = dataclasses.replace(learner.config, categorical=settings)
    return learner


def test_training_recovers_a_known_table(trained, fork):
    found = trained.log_probabilities(*fork.unseen(1)).exp().view(POINTS, POINTS)
    torch.testing.assert_close(found, TABLE, rtol=0, atol=0.03)


def test_samples_have_the_shares_of_the_table_and_temperature_sharpens_them(
    trained, fork, generator
):
    shares = {}
    for temperature in (1.0, 0.2):
        learner = acting(trained, choice="sample", temperature=temperature)
        actions = learner.act(*fork.unseen(4000), generator=generator)
        cells = nearest_points(actions, points=POINTS)
        shares[temperature] = torch.histc(
            (cells[:, 0] * POINTS + cells[:, 1]).float(), bins=POINTS**2, min=0, max=POINTS**2
        ).view(POINTS, POINTS) / len(actions)
    torch.testing.assert_close(shares[1.0], TABLE, rtol=0, atol=0.04)
    areas = cell_areas(POINTS, device=torch.device("cpu")).view(POINTS, POINTS)
    sharp = (TABLE / areas) ** 5 * areas
    sharp /= sharp.sum()
    torch.testing.assert_close(shares[0.2], sharp, rtol=0, atol=0.08)


def test_argmax_takes_the_densest_cell_not_the_heaviest(trained, fork, generator):
    """That at the edge is half as large, and so denser with 0.3 than one inside with 0.45."""
    learner = acting(trained, choice="argmax")
    actions = learner.act(*fork.unseen(2), generator=generator)
    torch.testing.assert_close(actions, torch.tensor([[-1.0, 0.0]]).expand(2, -1))


def test_the_density_integrates_to_one_and_is_constant_in_a_cell(trained, fork):
    axis = torch.linspace(-1, 1, 129)[1:] - 1 / 128
    cells = torch.cartesian_prod(axis, axis)[None]
    mass = float(trained.log_density(*fork.unseen(1), cells).exp().sum()) * (2 / 128) ** 2
    assert mass == pytest.approx(1, abs=1e-4)
    near = torch.tensor([[[-0.5, 0.5], [-0.39, 0.61], [-0.37, 0.5]]])
    told = trained.log_density(*fork.unseen(1), near)[0]
    assert told[0] == told[1] > told[2]
