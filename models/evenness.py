"""Weights that let training meet rare speeds more often, and leave what is learnt at each speed as it is."""

import torch
from jaxtyping import Float
from torch import Tensor

from models.config import EvennessConfig
from models.density import kernel_density

# Points that the density of the speed is computed at; between them it is interpolated.
POINTS = 512


def speed_weights(speeds: Float[Tensor, " D"], config: EvennessConfig) -> Float[Tensor, " D"]:
    """How often to draw each pair, by the speed that was seen.

    Args:
        speeds: Of each pair [m/s].
        config: Power and kernel.

    Returns:
        (1 / density of the speed) ** speed_exponent, brought to a mean of one [-].
    """
    if config.speed_exponent == 0:
        return torch.ones_like(speeds)
    low, high = speeds.min(), speeds.max()
    width = (high - low).clamp(min=config.speed_bandwidth)
    points = low + width * torch.linspace(0, 1, POINTS, device=speeds.device)
    density = kernel_density(
        points[:, None], speeds[:, None], bandwidth=config.speed_bandwidth, kind="joint"
    )
    place = (speeds - low) / width * (POINTS - 1)
    left = place.long().clamp(max=POINTS - 2)
    weights = torch.lerp(density[left], density[left + 1], place - left) ** -config.speed_exponent
    return weights / weights.mean()
