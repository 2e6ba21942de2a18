"""How many steps the density of diffusion and flow takes: the table of docs/methods.md.

The velocity is the exact one of three modes, one of them a point, so that all of the error is that of the steps.

    python scripts/ode_steps.py
"""

import math
from collections.abc import Sequence

import rich_click as click
import torch
from jaxtyping import Float64
from torch import Tensor

from models.ode_density import log_density, noise_ratios

MASSES = (0.45, 0.35, 0.2)
CENTRES = ((0.1, 0.4), (0.3, -0.4), (-0.8, 0.0))
DEVIATIONS = (0.05, 0.08, 0.0)
CEILING = 30.0
"""Largest ratio of noise to action before the step to nothing but noise, as in the models [-]."""
POINTS = 41
"""Along each axis of the grid over [-1, 1]^2 on which densities are compared."""


def log_mixture(x: Float64[Tensor, "N 2"], *, scale: float, noise: float) -> Tensor:
    """Log density of the modes, scaled, with Gaussian noise added [nats]."""
    logs = []
    for mass, centre, deviation in zip(MASSES, CENTRES, DEVIATIONS, strict=True):
        variance = (scale * deviation) ** 2 + noise**2
        square = (x - scale * torch.tensor(centre, dtype=x.dtype)).square().sum(dim=1)
        logs.append(math.log(mass / (2 * math.pi * variance)) - square / (2 * variance))
    return torch.stack(logs).logsumexp(dim=0)


def velocity(x: Float64[Tensor, "N 2"], time: float) -> tuple[Tensor, Tensor]:
    """Flow from noise at time 0 to the modes at time 1, x = time * action + (1 - time) * noise, with its divergence."""
    level = 1 - time
    x = x.detach().requires_grad_()
    if time == 0:
        mean = torch.tensor(CENTRES, dtype=x.dtype).T @ torch.tensor(MASSES, dtype=x.dtype)
        return (mean - x).detach(), torch.full_like(x[:, 0], -2.0).detach()
    logs = log_mixture(x, scale=time, noise=level)
    (score,) = torch.autograd.grad(logs.sum(), x, create_graph=True)
    # Tweedie's formula: the mean of the action given x; the flow is (action - noise) on average.
    action = (x + level**2 * score) / time
    rate = (action - x) / level
    slopes = [
        torch.autograd.grad(rate[:, axis].sum(), x, retain_graph=True)[0][:, axis]
        for axis in range(2)
    ]
    return rate.detach(), (slopes[0] + slopes[1]).detach()


def evenly(floor: float, num_steps: int) -> list[float]:
    """Ratios evenly spaced in the logarithm."""
    ratio = CEILING / floor
    return [floor * ratio ** (index / num_steps) for index in range(num_steps + 1)]


def error(ratios: Sequence[float]) -> float:
    """Half the sum of absolute differences from the closed form: 0 for the same density, 1 for nothing in common [-]."""
    times = [1 / (1 + ratio) for ratio in ratios] + [0.0]
    axis = torch.linspace(-1, 1, POINTS, dtype=torch.float64)
    points = torch.cartesian_prod(axis, axis)
    found = log_density(velocity, times[0] * points, times) + 2 * math.log(times[0])
    expected = log_mixture(points, scale=1.0, noise=ratios[0])
    cell = float(axis[1] - axis[0]) ** 2
    return float((found.exp() - expected.exp()).abs().sum()) * cell / 2


@click.command()
@click.option("--steps", default="8,12,16,24", show_default=True, help="Numbers of steps.")
def main(steps: str) -> None:
    """Print the table."""
    print("| steps | noise floor 0.05 | 0.03 | 0.03, spaced evenly in the logarithm |")
    print("|---|---|---|---|")
    for count in map(int, steps.split(",")):
        columns = [noise_ratios(0.05, CEILING, count), noise_ratios(0.03, CEILING, count)]
        columns.append(evenly(0.03, count))
        print(f"| {count} | " + " | ".join(f"{error(it):.4f}" for it in columns) + " |")


if __name__ == "__main__":
    main()
