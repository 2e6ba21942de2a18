import dataclasses
import math

import pytest
import torch

from models.config import DensityConfig
from models.density import action_density, inverse_weights, kernel_density
from models.samplers.grid import action_grid


@pytest.fixture
def data(generator):
    return torch.randn(100, 2, generator=generator) * 0.2


@pytest.mark.parametrize("kind", ["joint", "product"])
def test_the_estimate_integrates_to_one(kind, data):
    points = 2 * action_grid(81)
    density = kernel_density(points, data, bandwidth=0.2, kind=kind)
    assert density.sum().item() * (4 / 80) ** 2 == pytest.approx(1, abs=1e-3)


def test_a_single_point_gives_the_kernel():
    density = kernel_density(
        torch.tensor([[0.3, -0.4]]), torch.zeros(1, 2), bandwidth=0.5, kind="joint"
    )
    # exp(-r^2 / 2 h^2) / (2 pi h^2) with r = 0.5 = h
    assert density.item() == pytest.approx(math.exp(-0.5) / (2 * math.pi * 0.25))


def test_in_one_dimension_it_is_the_formula_of_the_paper(data):
    steering, h = data[:, 1:], 0.2
    point = torch.tensor([[0.1]])
    u = (point - steering) / h
    kernel = torch.exp(-u.square() / 2) / math.sqrt(2 * math.pi)
    expected = kernel.sum() / (len(data) * h)
    found = kernel_density(point, steering, bandwidth=h, kind="product")
    assert found.item() == pytest.approx(expected.item(), rel=1e-5)


def test_joint_and_product_agree_on_a_lattice_and_not_on_a_diagonal(generator):
    lattice = torch.cartesian_prod(torch.tensor([-0.5, 0.1]), torch.tensor([0.0, 0.7]))
    for data, agree in ((lattice, True), (torch.tensor([[-1.0, -1.0], [1.0, 1.0]]), False)):
        joint, product = (
            kernel_density(data, data, bandwidth=0.2, kind=kind) for kind in ("joint", "product")
        )
        assert torch.allclose(joint, product) == agree


def test_inverse_weights_even_out_two_clusters():
    actions = torch.tensor([[0.9, 0.9]] * 90 + [[-0.9, -0.9]] * 10)
    weights = inverse_weights(action_density(actions, DensityConfig()), DensityConfig())
    assert weights[:90].sum().item() == pytest.approx(weights[90:].sum().item(), rel=1e-4)
    assert weights.mean().item() == pytest.approx(1)


def test_the_exponent_tempers_and_the_cap_limits():
    density = torch.tensor([1.0] * 99 + [0.0001])
    half = inverse_weights(density, dataclasses.replace(DensityConfig(), exponent=0.5))
    assert (half[-1] / half[0]).item() == pytest.approx(100, rel=1e-4)
    capped = inverse_weights(density, dataclasses.replace(DensityConfig(), cap=3.0))
    full = inverse_weights(density, DensityConfig())
    assert (capped[-1] / capped[0]).item() == pytest.approx(3 / full[0].item(), rel=1e-4)


@pytest.mark.parametrize("kind", ["joint", "product"])
@pytest.mark.parametrize("bandwidth", [0.01, 0.032, 0.2])
def test_the_density_of_actions_is_the_exact_one_within_a_thousandth(kind, bandwidth, generator):
    actions = torch.rand(2000, 2, generator=generator) ** 3 * 2 - 1
    actions[:200] = torch.tensor([-1.0, 0.0])  # as waiting repeats itself
    config = DensityConfig(bandwidth=bandwidth, kind=kind)
    exact = kernel_density(actions.double(), actions.double(), bandwidth=bandwidth, kind=kind)
    torch.testing.assert_close(action_density(actions, config), exact.float(), rtol=1e-3, atol=0.0)
