import itertools
import math

import pytest
import torch

from models.ode_density import log_density, noise_ratios


def growth(rate):
    """Velocity of dx/dt = rate x, which keeps Gaussian noise Gaussian."""
    return lambda x, time: (rate * x, torch.full_like(x[:, 0], 2 * rate))


def test_growing_noise_is_a_wider_gaussian():
    points = torch.tensor([[0.0, 0.0], [0.5, -1.0]], dtype=torch.float64)
    times = [1 - index / 20 for index in range(21)]
    found = log_density(growth(0.7), points, times)
    deviation = math.exp(0.7)
    expected = -0.5 * (points / deviation).square().sum(dim=1) - math.log(
        2 * math.pi * deviation**2
    )
    torch.testing.assert_close(found, expected, rtol=0, atol=1e-6)


def test_the_error_falls_with_the_fourth_power_of_the_step():
    points = torch.tensor([[0.5, -1.0]], dtype=torch.float64)
    found = [
        float(log_density(growth(1.0), points, [1 - i / num for i in range(num + 1)]))
        for num in (4, 8, 256)
    ]
    assert (found[0] - found[2]) / (found[1] - found[2]) == pytest.approx(16, rel=0.2)


@pytest.mark.parametrize("kind", ["diffusion", "flow"])
def test_two_modes_have_their_density_when_the_velocity_is_exact(kind, fork):
    """The settings of the presets, along the paths of both generative policies."""
    floor, ratios = 0.05, noise_ratios(0.05, 30.0, 12)

    def mixture(time):
        if kind == "flow":
            return time, 1 - time, 1.0, -1.0
        angle = math.pi / 2 * time
        signal, level = math.cos(angle), math.sin(angle)
        return signal, level, -math.pi / 2 * level, math.pi / 2 * signal

    def velocity(x, time):
        signal, level, signal_rate, level_rate = mixture(time)

        def at(x):
            clean = fork.clean(x, signal, level)
            return signal_rate * clean + level_rate * (x - signal * clean) / level

        x = x.detach().requires_grad_()
        rate = at(x)
        slopes = [
            torch.autograd.grad(rate[:, axis].sum(), x, retain_graph=True)[0][:, axis]
            for axis in range(2)
        ]
        return rate.detach(), sum(slopes)

    if kind == "flow":
        times = [1 / (1 + ratio) for ratio in ratios] + [0.0]
    else:
        times = [2 / math.pi * math.atan(ratio) for ratio in ratios] + [1.0]
    signal = mixture(times[0])[0]
    axis = torch.linspace(-1, 1, 41, dtype=torch.float64)
    points = torch.cartesian_prod(axis, axis)
    found = log_density(velocity, signal * points, times) + 2 * math.log(signal)
    expected = fork.log_density(points, noise=floor)
    cell = float(axis[1] - axis[0]) ** 2
    assert float((found.exp() - expected.exp()).abs().sum()) * cell / 2 < 0.01
    likely = expected > -3
    torch.testing.assert_close(found[likely], expected[likely], rtol=0, atol=0.03)


def test_ratios_go_from_floor_to_ceiling_in_growing_steps():
    ratios = noise_ratios(0.05, 30.0, 12)
    assert (ratios[0], ratios[-1]) == (pytest.approx(0.05), pytest.approx(30.0))
    steps = [b - a for a, b in itertools.pairwise(ratios)]
    assert steps == sorted(steps)
    assert steps[0] < ratios[0]
