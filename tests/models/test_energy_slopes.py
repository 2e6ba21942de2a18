import pytest
import torch

from models.energy import EnergyHead
from models.energy_slopes import EnergySlopes

B, N, F = 4, 30, 16


@pytest.fixture
def head():
    torch.manual_seed(0)
    return EnergyHead(F, action_gain=8.0)


@pytest.fixture
def inputs(generator):
    features = torch.randn(B, F, generator=generator)
    return features, 2 * torch.rand(B, N, 2, generator=generator) - 1


def autograd_slopes(head, features, actions, *, create_graph=False):
    actions = actions.clone().requires_grad_()
    energies = head(features, actions).sum()
    return torch.autograd.grad(energies, actions, create_graph=create_graph)[0]


def test_slopes_are_those_of_autograd(head, inputs):
    slopes = EnergySlopes(head, inputs[0])(inputs[1])
    torch.testing.assert_close(slopes, autograd_slopes(head, *inputs))


def test_the_gradient_of_a_penalty_on_slopes_is_that_of_autograd_twice(head, inputs):
    parameters = dict(head.named_parameters())
    of_slopes = {
        name: parameters[name] for name in ("first.weight", "second.weight", "last.weight")
    }
    found, expected = (
        torch.autograd.grad(slopes.square().mean(), of_slopes.values())
        for slopes in (
            EnergySlopes(head, inputs[0])(inputs[1]),
            autograd_slopes(head, *inputs, create_graph=True),
        )
    )
    for name, one, other in zip(of_slopes, found, expected, strict=True):
        torch.testing.assert_close(one, other, rtol=1e-4, atol=1e-7, msg=name)


def test_slopes_in_bfloat16_are_near(head, inputs):
    exact, rounded = (
        EnergySlopes(head, inputs[0], precision)(inputs[1]) for precision in ("float32", "bfloat16")
    )
    error = (rounded - exact).detach().norm() / exact.detach().norm()
    assert float(error) < 0.05
    assert rounded.dtype == torch.float32
