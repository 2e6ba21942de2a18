"""The Beta density over actions: where it is highest, and how to draw from it with a generator."""

import torch
from jaxtyping import Float
from torch import Tensor
from torch.distributions import Beta

# Softplus underflows to zero, where the Beta density does not exist.
SMALLEST_CONCENTRATION = 1e-6


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
