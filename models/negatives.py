"""Negative examples: actions that the expert did not choose here."""

import math

import torch
from jaxtyping import Float
from torch import Tensor

from models.config import NegativesConfig
from models.interfaces import ACTION_BOUND, ACTION_SIZE

# Pairs of a point and an expert action at a time, 1 MB of exponents, so that they stay in the cache of a CPU core; a
# GPU wants more.
PAIRS_AT_A_TIME = {"cpu": 2**18, "cuda": 2**26}


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


@torch.no_grad()
def log_density(
    actions: Float[Tensor, "B N 2"], expert_actions: Float[Tensor, "P 2"], config: NegativesConfig
) -> Float[Tensor, "B N"]:
    """Log of the density that `mixed_negatives` draws from, for negatives that are not clipped.

    Args:
        actions: Where to evaluate it [-].
        expert_actions: What was disturbed [-].
        config: Noise and share of uniform negatives.

    Returns:
        Log density per unit of action area [nats].
    """
    num_uniform = round(config.uniform_share * config.count)
    share = num_uniform / config.count
    points = actions.float().flatten(0, 1)  # (B N, 2)
    disturbed = _log_gaussian_mixture(points, expert_actions.float(), sigma=config.sigma)
    if num_uniform == 0:
        return disturbed.view(actions.shape[:2])
    inside = (points.abs() <= ACTION_BOUND).all(dim=1)
    uniform = torch.where(
        inside, math.log(share) - ACTION_SIZE * math.log(2 * ACTION_BOUND), -math.inf
    )
    if num_uniform == config.count:
        return uniform.view(actions.shape[:2])
    return torch.logaddexp(disturbed + math.log(1 - share), uniform).view(actions.shape[:2])


def _log_gaussian_mixture(
    points: Float[Tensor, "M 2"], centers: Float[Tensor, "P 2"], *, sigma: float
) -> Float[Tensor, " M"]:
    """Log density of a mixture of equal Gaussians of standard deviation sigma around the centers [nats].

    -|x - c|^2 / 2 = x c - |c|^2 / 2 - |x|^2 / 2, whose last term is the same for all centers: what is left is one
    product of (x, 1) with (c, -|c|^2 / 2), a part of the points at a time.
    """
    scaled, columns = points / sigma, centers / sigma  # (M, 2), (P, 2)
    constants = columns.square().sum(dim=1).mul_(-0.5)  # (P,)
    rows = max(1, PAIRS_AT_A_TIME[points.device.type] // len(centers))
    with torch.autocast(points.device.type, enabled=False):
        sums = [
            torch.addmm(constants, part, columns.T).logsumexp(dim=1) for part in scaled.split(rows)
        ]
    normaliser = math.log(len(centers) * 2 * math.pi * sigma**2)
    return torch.cat(sums) - 0.5 * scaled.square().sum(dim=1) - normaliser
