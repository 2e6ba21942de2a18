"""Density of what an ordinary differential equation makes of Gaussian noise, by integrating its divergence.

Along a path of dx/dt = v(x, t) the density changes by d log p / dt = -div v. From an action the path is followed
back to the noise, whose density is known.

Reference:
    Chen et al., Neural Ordinary Differential Equations, NeurIPS 2018, (8); Song et al., Score-Based Generative Modeling
    through Stochastic Differential Equations, ICLR 2021, (39).
"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import torch
from jaxtyping import Float
from torch import Tensor

Velocity = Callable[[Tensor, float], tuple[Tensor, Tensor]]
"""Points (N, 2) [-] and a time [-] to the velocity (N, 2) [-] and its divergence (N) [-]."""


# Between two modes the paths part, the faster the less noise there is, so steps shrink faster than the noise does.
SPACING = -0.4


def noise_ratios(floor: float, ceiling: float, num_steps: int) -> list[float]:
    """Ratios of noise to action to step through, evenly spaced in a power of themselves.

    Args:
        floor: The smallest, at the action [-].
        ceiling: The largest, at the noise [-].
        num_steps: Steps between both.

    Returns:
        One more than that, ascending [-].
    """
    first, last = floor**SPACING, ceiling**SPACING
    return [
        (first + (last - first) * index / num_steps) ** (1 / SPACING)
        for index in range(num_steps + 1)
    ]


def log_density(
    velocity: Velocity, points: Float[Tensor, "N 2"], times: Sequence[float]
) -> Float[Tensor, " N"]:
    """Log of the density of points at the first time, when at the last it is that of standard Gaussian noise.

    Args:
        velocity: Right-hand side of the equation, with its divergence.
        points: Where to tell the density [-].
        times: From the action to the noise, in either direction; each step is one of the classical Runge-Kutta method [-].

    Returns:
        Log densities [nats].
    """
    x = points
    gained = torch.zeros_like(points[:, 0])
    for start, end in pairwise(times):
        x, gain = _runge_kutta_step(velocity, x, start, end)
        gained = gained + gain
    return gained - 0.5 * x.square().sum(dim=1) - math.log(2 * math.pi)


def _runge_kutta_step(
    velocity: Velocity, x: Tensor, start: float, end: float
) -> tuple[Tensor, Tensor]:
    """One step of the points, and the integral of the divergence over it."""
    length, middle = end - start, (start + end) / 2
    v1, d1 = velocity(x, start)
    v2, d2 = velocity(x + length / 2 * v1, middle)
    v3, d3 = velocity(x + length / 2 * v2, middle)
    v4, d4 = velocity(x + length * v3, end)
    x = x + length / 6 * (v1 + 2 * (v2 + v3) + v4)
    return x, length / 6 * (d1 + 2 * (d2 + d3) + d4)
