import itertools
import math

import pytest
import torch

from models.config import GridConfig
from models.samplers import grid
from models.samplers.commitment import draw_committed, next_noise

POINTS = 33


def log_weights(*peaks: tuple[float, float, float]) -> torch.Tensor:
    """Peaks of some mass at some acceleration and steering on a grid, one row."""
    actions = grid.action_grid(POINTS)
    density = sum(
        mass * torch.exp(-0.5 * ((actions - torch.tensor(centre)) / 0.1).square().sum(dim=1))
        for mass, *centre in peaks
    )
    return torch.log(density + 1e-12)[None]


FORK = log_weights((0.65, -0.3, 0.5), (0.35, 0.3, -0.5))
"""Who turns to the left brakes."""


def drawn(rows, noise, generator) -> torch.Tensor:
    indices = draw_committed(rows, noise, generator=generator)
    return grid.action_grid(POINTS)[indices.squeeze(1)]


def test_what_is_drawn_at_one_moment_is_as_without_commitment(generator):
    num_draws = 20_000
    actions = drawn(
        FORK.expand(num_draws, -1),
        next_noise(None, num_draws, hold=9, generator=generator),
        generator,
    )
    shares = torch.softmax(FORK, dim=1)
    assert (actions[:, 1] > 0).float().mean().item() == pytest.approx(0.65, abs=0.02)
    points = grid.action_grid(POINTS)
    mean = shares @ points
    expected = (points - mean).T @ ((points - mean) * shares.T)
    torch.testing.assert_close(actions.mean(dim=0), mean[0], atol=0.02, rtol=0)
    torch.testing.assert_close(actions.T.cov(), expected, atol=0.01, rtol=0)


@pytest.mark.parametrize("noise", [-2.0, -0.5, 0.0, 2.0])
def test_steering_keeps_its_place_and_acceleration_is_drawn_anew(noise, generator):
    actions = drawn(FORK.expand(50, -1), torch.full((50,), noise), generator)
    assert len(set(actions[:, 1].tolist())) == 1
    assert len(set(actions[:, 0].tolist())) > 3
    is_left = noise > -0.385  # 0.35 of all noise is smaller
    assert (actions[:, 1] > 0).all() == is_left
    assert (actions[:, 0].mean() < 0) == is_left, "acceleration goes with steering"


def test_a_mode_that_splits_is_followed_to_the_same_side(generator):
    """Half of all turn left, little by little: whoever begins to, must not begin anew at each moment."""
    for noise, turns_left in ((1.0, True), (-1.0, False)):
        steering = [
            drawn(
                log_weights((0.5, 0.0, 0.0), (0.5, 0.0, 0.05 * step)),
                torch.tensor([noise]),
                generator,
            )[0, 1].item()
            for step in range(11)
        ]
        assert (steering[-1] > 0.3) == turns_left
        if turns_left:
            assert all(b >= a - 1e-6 for a, b in itertools.pairwise(steering))


def test_a_side_is_left_when_it_is_no_way_any_more(generator):
    noise = torch.tensor([2.0])  # far to the left
    assert drawn(FORK, noise, generator)[0, 1] > 0
    assert drawn(log_weights((1.0, 0.3, -0.5)), noise, generator)[0, 1] < 0


def test_the_grid_sampler_keeps_to_the_noise(generator):
    def energy(actions):
        del actions
        return -FORK

    config = GridConfig(points=POINTS)
    for side in (-1.0, 1.0):
        chosen = grid.choose(energy, config, generator=generator, noise=torch.tensor([2.0 * side]))
        assert (chosen[:, 1] * side > 0).all()


def test_noise_is_standard_normal_at_each_moment_and_fades_as_it_should(generator):
    first = noise = next_noise(None, 20_000, hold=5, generator=generator)
    for _ in range(5):
        noise = next_noise(noise, 20_000, hold=5, generator=generator)
    assert noise.mean().item() == pytest.approx(0.0, abs=0.03)
    assert noise.var().item() == pytest.approx(1.0, rel=0.04)
    alike = torch.corrcoef(torch.stack([first, noise]))[0, 1].item()
    assert alike == pytest.approx(math.exp(-1), abs=0.03)


@pytest.mark.parametrize("noise", [-40.0, 40.0])
def test_noise_without_bounds_stays_on_the_grid(noise, generator):
    assert drawn(FORK, torch.tensor([noise]), generator).abs().max() <= 1
