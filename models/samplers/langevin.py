"""Langevin dynamics on an energy: chains that walk down its slope, with noise."""

from collections.abc import Callable

import torch
from jaxtyping import Float
from torch import Tensor

from models.config import ChainConfig, LangevinConfig
from models.interfaces import ACTION_BOUND, ACTION_SIZE
from models.samplers.dfo import EnergyFunction
from models.samplers.draws import draw_categorical, pick

SlopeFunction = Callable[[Tensor], Tensor]
"""Actions (B, N, 2) [-] to the slopes of their energies along each component (B, N, 2) [nats]."""


def step_sizes(config: ChainConfig) -> list[float]:
    """Step size of each iteration, falling as a polynomial from the first to the last [-]."""
    span = config.step_init - config.step_final
    last = max(1, config.iterations - 1)
    return [
        config.step_final + span * (1 - index / last) ** config.step_power
        for index in range(config.iterations)
    ]


def draw_noise(
    num_observations: int, num_chains: int, config: ChainConfig, *, generator: torch.Generator
) -> Float[Tensor, "B S N 2"]:
    """Draw all that chance decides about some chains.

    Args:
        num_observations: Observations with chains of their own.
        num_chains: Chains of each.
        config: How many steps they take.
        generator: Source of chance; the noise lies on its device.

    Returns:
        Standard normal numbers, for S steps [-].
    """
    shape = (num_observations, config.iterations, num_chains, ACTION_SIZE)
    return torch.randn(shape, generator=generator, device=generator.device)


@torch.no_grad()
def walk(
    slopes: SlopeFunction,
    start: Float[Tensor, "B N 2"],
    noise: Float[Tensor, "B S N 2"],
    config: ChainConfig,
) -> Float[Tensor, "B N 2"]:
    """Let chains walk.

    Args:
        slopes: Of the energy.
        start: Where the chains begin [-].
        noise: From `draw_noise` [-].
        config: Step sizes, noise and clip.

    Returns:
        Where they end, in [-1, 1] [-].

    Reference:
        Welling, Teh, Bayesian Learning via Stochastic Gradient Langevin Dynamics, ICML 2011; clipped steps and the noise
        "step" are those of the code of Florence et al., Implicit Behavioral Cloning, CoRL 2022.
    """
    actions = start
    for index, size in enumerate(step_sizes(config)):
        spread = config.noise_scale * (size if config.noise == "step" else size**0.5)
        change = spread * noise[:, index] - 0.5 * size * slopes(actions)
        change = change.clamp_(-config.step_clip, config.step_clip)
        actions = (actions + change).clamp_(-ACTION_BOUND, ACTION_BOUND)
    return actions


def search(
    energy: EnergyFunction,
    slopes: SlopeFunction,
    start: Float[Tensor, "B N 2"],
    config: LangevinConfig,
    *,
    generator: torch.Generator,
) -> Float[Tensor, "B 2"]:
    """Let chains walk, and choose one of their ends.

    Args:
        energy: Scores the ends.
        slopes: Of the same energy.
        start: Where the chains begin [-].
        config: Walk and final choice.
        generator: Source of chance, on the device of the start.

    Returns:
        One action an observation [-].
    """
    num_observations, num_chains, _ = start.shape
    noise = draw_noise(num_observations, num_chains, config.chain, generator=generator)
    ends = walk(slopes, start, noise, config.chain)
    energies = energy(ends)  # (B, N)
    if config.choice == "argmin":
        return pick(ends, energies.argmin(dim=1, keepdim=True)).squeeze(1)
    # Starts may be sorted, so that "chain" cannot take the first one.
    logits = -energies if config.choice == "sample" else torch.zeros_like(energies)
    chosen = draw_categorical(torch.softmax(logits, dim=1), 1, generator=generator)
    return pick(ends, chosen).squeeze(1)
