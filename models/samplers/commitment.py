"""Steering that keeps to its place in the distribution for a while, without a change of what is chosen at each moment."""

import math

import torch
from jaxtyping import Float, Int
from torch import Tensor

from models.samplers.draws import draw_categorical, invert_cumulative


def next_noise(
    noise: Float[Tensor, " B"] | None, num_drivers: int, *, hold: int, generator: torch.Generator
) -> Float[Tensor, " B"]:
    """Go on with noise that lasts, a first-order autoregressive process; each value alone is standard normal.

    Args:
        noise: That of the last decision; None to begin.
        num_drivers: How many decide at once, each with noise of its own.
        hold: Decisions after which the correlation has fallen to 1/e; at least 1 [-].
        generator: Source of chance; the noise lies on its device.

    Returns:
        The noise of the next decision [-].

    Reference:
        Uhlenbeck and Ornstein, On the theory of the Brownian motion, 1930.
    """
    fresh = torch.randn(num_drivers, generator=generator, device=generator.device)
    if noise is None:
        return fresh
    kept = math.exp(-1.0 / hold)
    return kept * noise + math.sqrt(1.0 - kept**2) * fresh


def draw_committed(
    log_weights: Float[Tensor, "B N"], noise: Float[Tensor, " B"], *, generator: torch.Generator
) -> Int[Tensor, "B 1"]:
    """Draw points of a square grid of actions: steering by its quantile, then an acceleration that goes with it.

    With standard normal noise each point is drawn by its weight. Where the noise lasts, so does the place in the distribution of
    steering: of two modes the same one is taken again, and a mode that splits is followed to the same side.

    Args:
        log_weights: Log weight of each point, acceleration outermost, up to a constant of each row [nats].
        noise: Standard normal; the share of the distribution that steers further to the right is the share of noise below it [-].
        generator: Source of the draw of an acceleration.

    Returns:
        Indices into the second axis.

    Reference:
        Nelsen, An Introduction to Copulas, 2006: where ranks are kept from one moment to the next, marginals are free.
    """
    points = round(log_weights.shape[1] ** 0.5)
    weights = torch.softmax(log_weights, dim=1).unflatten(1, (points, points))
    quantile = torch.special.ndtr(noise.double())[:, None]
    steering = invert_cumulative(weights.sum(dim=1), quantile)  # (B, 1)
    column = weights.gather(2, steering[:, None].expand(-1, points, 1)).squeeze(2)  # (B, points)
    acceleration = draw_categorical(column, 1, generator=generator)
    return acceleration * points + steering
