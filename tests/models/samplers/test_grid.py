import math

import pytest
import torch

from models.config import GridConfig
from models.samplers.grid import action_grid, choose


def fork(actions):
    """65 % of the mass in a peak at steering 0.4, 35 % at -0.4, for 2000 observations alike."""
    steering = actions[..., 1]
    peaks = (0.65, 0.4), (0.35, -0.4)
    density = sum(
        mass * torch.exp(-0.5 * ((steering - centre) / 0.08).square()) for mass, centre in peaks
    )
    return -torch.log(density + 1e-9).expand(2000, -1)


def test_sampling_keeps_the_shares_of_a_fork(generator):
    actions = choose(fork, GridConfig(points=65), generator=generator)
    assert (actions[:, 1] > 0).float().mean().item() == pytest.approx(0.65, abs=0.03)


def test_a_low_temperature_sharpens_as_a_power(generator):
    actions = choose(fork, GridConfig(points=65, temperature=0.5), generator=generator)
    expected = 0.65**2 / (0.65**2 + 0.35**2)
    assert (actions[:, 1] > 0).float().mean().item() == pytest.approx(expected, abs=0.03)


def test_argmin_is_the_grid_point_next_to_the_bottom(generator):
    bottom = torch.tensor([[0.33, -0.71], [-1.0, 0.0]])

    def bowls(actions):
        return (actions - bottom[:, None]).square().sum(dim=-1)

    chosen = choose(bowls, GridConfig(points=101, choice="argmin"), generator=generator)
    assert (chosen - bottom).abs().max() <= 0.01 + 1e-6


def test_an_odd_grid_holds_rest_and_full_brake():
    grid = action_grid(5)
    assert len(grid) == 25
    for action in ([0.0, 0.0], [-1.0, 0.0], [1.0, 1.0]):
        assert (grid == torch.tensor(action)).all(dim=1).any()


def test_a_flat_energy_is_sampled_evenly(generator):
    actions = choose(
        lambda a: torch.zeros(4000, a.shape[1]), GridConfig(points=9), generator=generator
    )
    assert actions.std(dim=0).tolist() == pytest.approx(
        [action_grid(9)[:, 0].std(correction=0).item()] * 2, abs=0.03
    )
    assert math.isclose(actions.mean().item(), 0, abs_tol=0.03)
