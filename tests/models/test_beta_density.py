import math

import pytest
import torch
from torch.distributions import Beta

from models.beta_density import POINTS, beta_mode, draw_beta, log_cell_masses, unit_from_action


def test_the_mode_is_where_the_density_is_highest():
    alpha, beta = torch.tensor([[3.0, 5.0]]), torch.tensor([[2.0, 9.0]])
    grid = torch.linspace(0.001, 0.999, 999)[:, None]
    highest = grid[Beta(alpha, beta).log_prob(grid).argmax(dim=0), 0]
    torch.testing.assert_close(beta_mode(alpha, beta)[0], highest, rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("alpha", "beta", "mode"),
    [(0.5, 2.0, 0.0), (2.0, 0.5, 1.0), (0.5, 0.25, 2 / 3), (1.0, 1.0, 0.5)],
)
def test_the_mode_of_a_peakless_density_is_its_end_or_mean(alpha, beta, mode):
    found = beta_mode(torch.tensor([[alpha, alpha]]), torch.tensor([[beta, beta]]))
    torch.testing.assert_close(found, torch.tensor([[mode, mode]]))


def test_labels_keep_the_clamp_from_the_ends():
    labels = torch.tensor([[-1.0, 1.0], [0.0, 0.5]])
    unit = unit_from_action(labels, label_clamp=0.01)
    torch.testing.assert_close(unit, torch.tensor([[0.01, 0.99], [0.5, 0.75]]))


def test_draws_have_the_moments_of_the_density(generator):
    alpha = torch.tensor([2.0, 0.5]).expand(20_000, 2)
    beta = torch.tensor([5.0, 0.5]).expand(20_000, 2)
    drawn, known = draw_beta(alpha, beta, generator=generator), Beta(alpha[0], beta[0])
    torch.testing.assert_close(drawn.mean(dim=0), known.mean, rtol=0, atol=0.01)
    torch.testing.assert_close(drawn.var(dim=0), known.variance, rtol=0.05, atol=0)


def test_draws_leave_the_random_numbers_of_others_alone(generator):
    torch.manual_seed(0)
    before = torch.random.get_rng_state()
    draw_beta(torch.ones(1, 2), torch.ones(1, 2), generator=generator)
    assert torch.equal(torch.random.get_rng_state(), before)


@pytest.mark.parametrize(
    ("alpha", "beta", "cumulative"),
    [
        (1.0, 300.0, lambda x: 1 - (1 - x) ** 300),
        (300.0, 1.0, lambda x: x**300),
        (0.1, 1.0, lambda x: x**0.1),
        (1.0, 0.1, lambda x: 1 - (1 - x) ** 0.1),
        (0.5, 0.5, lambda x: 2 / math.pi * x.sqrt().asin()),
        (2.0, 3.0, lambda x: 6 * x**2 - 8 * x**3 + 3 * x**4),
        (2.0, 100.0, lambda x: 1 - (1 - x) ** 101 - 101 * x * (1 - x) ** 100),
    ],
)
def test_cells_hold_what_lies_in_them_also_where_the_density_has_no_bound(alpha, beta, cumulative):
    found = log_cell_masses(torch.tensor(alpha), torch.tensor(beta)).exp().double()
    half = 0.5 / (POINTS - 1)
    middles = torch.linspace(0, 1, POINTS, dtype=torch.float64)
    high, low = (middles + half).clamp(max=1), (middles - half).clamp(min=0)
    torch.testing.assert_close(found, cumulative(high) - cumulative(low), rtol=0.01, atol=2e-5)
    assert float(found.sum()) == pytest.approx(1, abs=1e-5)
