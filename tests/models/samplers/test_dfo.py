import dataclasses
import math

import pytest
import torch

from models.config import DfoConfig
from models.samplers.dfo import search

UNIFORM_START = DfoConfig(num_samples=1024, start="uniform")


def uniform_start(num_observations, num_samples, generator):
    return 2 * torch.rand(num_observations, num_samples, 2, generator=generator) - 1


def fork_energy(share_left, spread=0.08):
    """Two Gaussian modes at steering +-0.4, the left one with `share_left` of the mass, over a low floor."""

    def energy(actions):
        acceleration = (actions[..., 0] / spread).square()
        density = torch.full_like(acceleration, 1e-4)
        for steering, mass in ((0.4, share_left), (-0.4, 1 - share_left)):
            offset = ((actions[..., 1] - steering) / spread).square()
            density = density + mass * torch.exp(-0.5 * (acceleration + offset))
        return -density.log()

    return energy


def left_share(config, share_left, generator, num_observations=200):
    """Chance of the left mode: exact given the last candidates, averaged over searches."""
    start = uniform_start(num_observations, config.num_samples, generator)
    result = search(fork_energy(share_left), start, config, generator=generator)
    temperature = config.iterations if config.temper else 1
    probabilities = torch.softmax(-result.energies / temperature, dim=1)
    return (probabilities * (result.candidates[..., 1] > 0)).sum(dim=1).mean().item()


@pytest.mark.parametrize("bottom", [(0.3, -0.6), (-0.9, 0.1)])
def test_argmin_finds_the_bottom_of_a_bowl(bottom, generator):
    config = dataclasses.replace(UNIFORM_START, choice="argmin")
    target = torch.tensor(bottom)

    def bowl(actions):
        return 1000 * (actions - target).square().sum(dim=-1)

    start = uniform_start(3, config.num_samples, generator)
    found = search(bowl, start, config, generator=generator).actions
    assert (found - target).abs().max() < 0.02


def test_each_observation_of_a_batch_finds_its_own_bottom(generator):
    targets = torch.tensor([[-0.5, 0.2], [0.7, -0.7]])

    def bowls(actions):
        return 1000 * (actions - targets[:, None]).square().sum(dim=-1)

    config = dataclasses.replace(UNIFORM_START, choice="argmin")
    found = search(bowls, uniform_start(2, 1024, generator), config, generator=generator).actions
    assert (found - targets).abs().max() < 0.02


@pytest.mark.parametrize("iterations", [1, 2, 5])
def test_the_returned_energies_are_those_of_the_returned_candidates(iterations, generator):
    energy = fork_energy(0.65)
    config = dataclasses.replace(UNIFORM_START, iterations=iterations, choice="argmin")
    result = search(energy, uniform_start(4, 512, generator), config, generator=generator)
    torch.testing.assert_close(energy(result.candidates), result.energies)
    returned = energy(result.actions[:, None])[:, 0]
    torch.testing.assert_close(returned, result.energies.min(dim=1).values)


def test_one_iteration_samples_the_softmax_of_the_start(generator):
    start = torch.tensor([[[0.0, -0.5], [0.0, 0.5]]]).repeat(4000, 1, 1)

    def energy(actions):
        return torch.where(actions[..., 1] > 0, -math.log(0.8), -math.log(0.2))

    config = DfoConfig(num_samples=2, iterations=1)
    actions = search(energy, start, config, generator=generator).actions
    assert (actions[:, 1] > 0).float().mean().item() == pytest.approx(0.8, abs=0.03)


def test_resampling_again_and_again_sharpens_a_fork_about_as_its_fifth_power(generator):
    config = dataclasses.replace(UNIFORM_START, num_samples=4096)
    found = left_share(config, 0.65, generator, num_observations=100)
    assert found == pytest.approx(0.65**5 / (0.65**5 + 0.35**5), abs=0.05)  # 0.957


def test_the_lowest_candidate_lies_in_the_deeper_mode(generator):
    config = dataclasses.replace(UNIFORM_START, choice="argmin")
    start = uniform_start(100, config.num_samples, generator)
    found = search(fork_energy(0.65), start, config, generator=generator).actions
    assert (found[:, 1] > 0).float().mean() > 0.97


def test_tempering_keeps_the_shares_of_a_fork(generator):
    config = dataclasses.replace(UNIFORM_START, temper=True)
    assert left_share(config, 0.65, generator) == pytest.approx(0.65, abs=0.03)


def test_candidates_stay_within_the_bound(generator):
    config = dataclasses.replace(UNIFORM_START, sigma_init=3.0, shrink=1.0, bound=0.8)
    result = search(fork_energy(0.5), uniform_start(2, 256, generator), config, generator=generator)
    assert result.candidates.abs().max() <= 0.8
