"""Negative examples: actions that the expert did not choose here."""

import torch
from jaxtyping import Float
from torch import Tensor

from models.config import NegativesConfig
from models.interfaces import ACTION_BOUND, ACTION_SIZE


def uniform_actions(
    num_observations: int, count: int, *, generator: torch.Generator
) -> Float[Tensor, "B N 2"]:
    """Draw actions evenly from their box: the negatives of Florence et al. 2022, and one way to start a search.

    Args:
        num_observations: How many observations need negatives.
        count: Negatives for each.
        generator: Source of chance; the negatives lie on its device.

    Returns:
        Actions in [-1, 1] [-].
    """
    shape = (num_observations, count, ACTION_SIZE)
    unit = torch.rand(shape, generator=generator, device=generator.device)
    return ACTION_BOUND * (2 * unit - 1)


def perturbed_expert_negatives(
    expert_actions: Float[Tensor, "P 2"],
    num_observations: int,
    count: int,
    *,
    sigma: float,
    clip: bool,
    generator: torch.Generator,
) -> Float[Tensor, "B N 2"]:
    """Draw negatives from expert actions, with replacement, and add Gaussian noise (DA-IBC).

    Args:
        expert_actions: Where to draw from, whatever was observed there [-].
        num_observations: How many observations need negatives.
        count: Negatives for each.
        sigma: Standard deviation of the noise on each component [-].
        clip: Whether to bring the negatives back into [-1, 1].
        generator: Source of chance, on the device of the actions.

    Returns:
        One independent set an observation [-].
    """
    device = expert_actions.device
    shape = (num_observations, count)
    chosen = torch.randint(len(expert_actions), shape, generator=generator, device=device)
    noise = torch.randn((*shape, ACTION_SIZE), generator=generator, device=device)
    negatives = expert_actions[chosen] + sigma * noise
    return negatives.clamp(-ACTION_BOUND, ACTION_BOUND) if clip else negatives


def mixed_negatives(
    expert_actions: Float[Tensor, "P 2"],
    num_observations: int,
    config: NegativesConfig,
    *,
    generator: torch.Generator,
) -> Float[Tensor, "B N 2"]:
    """Perturbed expert actions with the share of uniform negatives that the settings ask for.

    Args:
        expert_actions: Where to draw from [-].
        num_observations: How many observations need negatives.
        config: Count, noise and share.
        generator: Source of chance, on the device of the actions.

    Returns:
        One independent set an observation [-].
    """
    num_uniform = round(config.uniform_share * config.count)
    perturbed = perturbed_expert_negatives(
        expert_actions,
        num_observations,
        config.count - num_uniform,
        sigma=config.sigma,
        clip=config.clip,
        generator=generator,
    )
    if num_uniform == 0:
        return perturbed
    uniform = uniform_actions(num_observations, num_uniform, generator=generator)
    return torch.cat((perturbed, uniform), dim=1)
