"""Diffusion and flow matching learn a known density, sample it, and tell it."""

import dataclasses

import pytest
import torch

from models.config import CommitmentConfig
from models.samplers.commitment import Commitment

CELLS = 48
EXTENT = 1.5


@pytest.fixture(scope="module", params=["diffusion", "flow"])
def learner(request, small_config, train_at_fork, fork):
    config = small_config(request.param)
    config = dataclasses.replace(config, denoiser=dataclasses.replace(config.denoiser, width=96))
    return train_at_fork(config, fork, steps=300, rate=5e-3)


@pytest.fixture(scope="module")
def cells():
    """Centres of the cells of a square that reaches well over the bounds of actions."""
    axis = EXTENT * ((torch.arange(CELLS) + 0.5) / CELLS * 2 - 1)
    return torch.cartesian_prod(axis, axis)


AREA = (2 * EXTENT / CELLS) ** 2


def test_samples_keep_the_masses_of_both_modes(learner, fork, generator):
    actions = learner.act(*fork.unseen(3000), generator=generator)
    is_left = actions[:, 1] > 0
    assert float(is_left.float().mean()) == pytest.approx(fork.share_left, abs=0.05)
    centres = fork.centres[(~is_left).long()]
    near = (actions - centres).norm(dim=1) < 4 * fork.deviation
    assert float(near.float().mean()) > 0.9


def test_the_density_integrates_to_one_and_is_that_of_the_demonstrations(learner, fork, cells):
    told = learner.log_density(*fork.unseen(1), cells[None])[0]
    assert float(told.exp().sum()) * AREA == pytest.approx(1, abs=0.02)
    left = float(told.exp()[cells[:, 1] > 0].sum()) * AREA
    assert left == pytest.approx(fork.share_left, abs=0.05)
    known = fork.log_density(cells, noise=learner.config.denoiser.noise_floor)
    assert float((told.exp() - known.exp()).abs().sum()) * AREA / 2 < 0.25
    divergence = float((known.exp() * (known - told)).sum()) * AREA
    assert divergence < 0.15


def test_the_density_of_one_action_does_not_hang_on_the_others(learner, fork, cells):
    few = cells[1000:1200]
    together = learner.log_density(*fork.unseen(2), few[None])
    alone = learner.log_density(*fork.unseen(1), few[None, 50:53])
    torch.testing.assert_close(together[0], together[1])
    torch.testing.assert_close(alone[0], together[0, 50:53], rtol=1e-4, atol=1e-4)


def test_where_chance_lasts_the_masses_of_both_modes_are_kept_and_each_driver_keeps_its_own(
    learner, fork, generator
):
    num_drivers = 300
    commitment = Commitment(CommitmentConfig(hold=10**9), num_drivers, generator=generator)
    seen = fork.unseen(num_drivers)
    first, then = (learner.act(*seen, generator=generator, commitment=commitment) for _ in range(2))
    is_left = first[:, 1] > 0
    assert float(is_left.float().mean()) == pytest.approx(fork.share_left, abs=0.06)
    same = is_left == (then[:, 1] > 0)
    assert float(same.float().mean()) > 0.97
    # Acceleration is drawn anew; steering moves by what the estimate does.
    moved = (then - first)[same].abs().median(dim=0).values
    assert moved[1] < 0.15 * moved[0]


def test_what_is_drawn_from_where_chance_lasts_has_the_noise_floor(learner, fork, generator):
    num_drivers = 400
    commitment = Commitment(CommitmentConfig(hold=1), num_drivers, generator=generator)
    seen = fork.unseen(num_drivers)
    lasting = learner.act(*seen, generator=generator, commitment=commitment)
    anew = learner.act(*seen, generator=generator)
    for component in (0, 1):
        left, plain = (it[it[:, 1] > 0][:, component] for it in (lasting, anew))
        expected = (plain.var() + learner.config.denoiser.noise_floor**2).sqrt()
        assert left.std() == pytest.approx(float(expected), rel=0.15)


@pytest.mark.parametrize("draws", [1, 4])
def test_times_cover_the_unit_interval_evenly(learner, draws, generator):
    denoiser = dataclasses.replace(learner.config.denoiser, draws=draws)
    config, learner.config = learner.config, dataclasses.replace(learner.config, denoiser=denoiser)
    chance = learner.draw(torch.zeros(4000, 2), generator=generator)
    learner.config = config
    assert chance.noise.shape == (4000, draws, 2)
    assert chance.times.shape == (4000, draws)
    counts = torch.histc(chance.times, bins=10, min=0, max=1) / chance.times.numel()
    torch.testing.assert_close(counts, torch.full((10,), 0.1), rtol=0, atol=0.02)
    ascending = chance.times.sort(dim=1).values.diff(dim=1)
    torch.testing.assert_close(ascending, torch.full_like(ascending, 1 / draws))
