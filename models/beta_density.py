"""The Beta density over actions: where it is highest, what cells hold of it, and how to draw from it with a generator."""

import math

import torch
from jaxtyping import Float
from torch import Tensor
from torch.distributions import Beta
from torch.nn import functional as F  # noqa: N812

# Softplus underflows to zero, where the Beta density does not exist.
SMALLEST_CONCENTRATION = 1e-6

POINTS = 129
"""Along each axis of the grid that stands for a density where chance lasts: a third of the label noise of the standard preset apart [-]."""

PARTS = 4
"""Of half a cell, in which its mass is integrated [-]."""


def unit_from_action(
    actions: Float[Tensor, "*B 2"], *, label_clamp: float
) -> Float[Tensor, "*B 2"]:
    """Bring actions from [-1, 1] into the open unit interval, where a Beta density is finite.

    Args:
        actions: Acceleration and steering in [-1, 1] [-].
        label_clamp: Smallest distance that is kept from 0 and 1 [-].

    Returns:
        The actions in [label_clamp, 1 - label_clamp] [-].
    """
    return ((actions + 1) / 2).clamp(label_clamp, 1 - label_clamp)


def beta_mode(alpha: Float[Tensor, "*B 2"], beta: Float[Tensor, "*B 2"]) -> Float[Tensor, "*B 2"]:
    """Where a Beta density is highest; its mean where it has two peaks or none.

    Args:
        alpha: First concentration [-].
        beta: Second concentration [-].

    Returns:
        A point in [0, 1] [-].
    """
    peaked = (alpha > 1) & (beta > 1)
    inner = (alpha - 1) / torch.where(peaked, alpha + beta - 2, 1.0)
    at_zero = (alpha <= 1) & (beta > 1)
    at_one = (alpha > 1) & (beta <= 1)
    edge_or_mean = torch.where(at_zero, 0.0, torch.where(at_one, 1.0, alpha / (alpha + beta)))
    return torch.where(peaked, inner, edge_or_mean)


def draw_beta(
    alpha: Float[Tensor, "*B 2"], beta: Float[Tensor, "*B 2"], *, generator: torch.Generator
) -> Float[Tensor, "*B 2"]:
    """Draw from Beta densities with a generator, which torch.distributions does not take.

    Args:
        alpha: First concentration [-].
        beta: Second concentration [-].
        generator: Source of chance, on their device.

    Returns:
        Points in [0, 1] [-].
    """
    device = generator.device
    seed = int(torch.randint(2**62, (), generator=generator, device=device))
    with torch.random.fork_rng(devices=[device] if device.type == "cuda" else []):
        torch.manual_seed(seed)
        return Beta(alpha, beta, validate_args=False).sample()


def draw_label_noise(
    actions: Float[Tensor, "B 2"], label_noise: float, *, generator: torch.Generator
) -> Float[Tensor, "B 2"] | None:
    """Noise to disturb labels with, so that a likelihood has a bound where they repeat exactly.

    Args:
        actions: The labels [-].
        label_noise: Standard deviation of the noise [-].
        generator: Source of chance, on their device.

    Returns:
        What to add to each [-]; None if that is nothing.
    """
    if label_noise == 0:
        return None
    return label_noise * torch.randn(actions.shape, generator=generator, device=actions.device)


def noisy_units(
    actions: Float[Tensor, "B 2"], noise: Float[Tensor, "B 2"] | None, *, label_clamp: float
) -> Float[Tensor, "B 2"]:
    """Labels with their noise, rescaled to the open unit interval [-]."""
    disturbed = actions if noise is None else actions + noise
    return unit_from_action(disturbed, label_clamp=label_clamp)


def log_cell_masses(
    alpha: Float[Tensor, "*B"], beta: Float[Tensor, "*B"], *, points: int = POINTS
) -> Float[Tensor, "*B P"]:
    """Log probability of the cell of each of some even points of [0, 1], which reaches halfway to its neighbours.

    Args:
        alpha: First concentration [-].
        beta: Second concentration [-].
        points: Including both ends, whose cells reach inwards only [-].

    Returns:
        Masses [nats], to about 1 % of each that matters and together 1; a density without a bound at an end is integrated there in closed form.
    """
    num = 2 * PARTS * (points - 1)
    width = 1.0 / num
    middles = (torch.arange(num, device=alpha.device) + 0.5) * width
    density = Beta(alpha[..., None], beta[..., None], validate_args=False)
    parts = density.log_prob(middles) + math.log(width)  # (*B, num)
    norm = torch.lgamma(alpha) + torch.lgamma(beta) - torch.lgamma(alpha + beta)
    for end, near, far in ((0, alpha, beta), (-1, beta, alpha)):
        # The integral of u^(near - 1) over the part, times what else hangs on u, which hardly changes there.
        parts[..., end] = (
            near * math.log(width) - near.log() - norm + (far - 1) * math.log1p(-width / 2)
        )
    padded = F.pad(parts, (PARTS, PARTS), value=-torch.inf)
    masses = torch.logsumexp(padded.unflatten(-1, (points, 2 * PARTS)), dim=-1)
    return F.log_softmax(masses, dim=-1)
