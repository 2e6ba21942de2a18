"""Derivative-free optimisation of an energy: score, resample, disturb, and score again (Algorithm 1 of the paper)."""

from collections.abc import Callable
from typing import NamedTuple

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from models.config import DfoConfig

EnergyFunction = Callable[[Tensor], Tensor]
"""Candidates (B, N, 2) [-], or (1, N, 2) shared by all observations, to energies (B, N) [nats]."""


class DfoResult(NamedTuple):
    """What the search ended with; every energy belongs to the candidate of the same index.

    Attributes:
        actions: The chosen candidates, shape (B, 2) [-].
        candidates: The last candidates, shape (B, N, 2) [-].
        energies: Their energies, shape (B, N) [nats].
    """

    actions: Tensor
    candidates: Tensor
    energies: Tensor


def draw_categorical(
    probabilities: Float[Tensor, "B N"], num_draws: int, *, generator: torch.Generator
) -> Int[Tensor, "B S"]:
    """Draw indices with replacement by inverting the cumulative sum; quicker than torch.multinomial for many draws.

    Args:
        probabilities: Non-negative weights of the indices; they need not sum to one [-].
        num_draws: Draws for each row.
        generator: Source of chance, on the device of the probabilities.

    Returns:
        Indices into the second axis.
    """
    cumulative = probabilities.double().cumsum(dim=1)
    shape = (len(probabilities), num_draws)
    unit = torch.rand(shape, generator=generator, device=probabilities.device, dtype=torch.float64)
    # side="right" skips indices of probability zero; the clamp meets a draw at the very end.
    drawn = torch.searchsorted(cumulative, unit * cumulative[:, -1:], right=True)
    return drawn.clamp(max=probabilities.shape[1] - 1)


def pick(candidates: Float[Tensor, "B N 2"], indices: Int[Tensor, "B S"]) -> Float[Tensor, "B S 2"]:
    """Candidates [-] at some indices of each row."""
    return torch.take_along_dim(candidates, indices[..., None], dim=1)


def search(
    energy: EnergyFunction,
    start: Float[Tensor, "B N 2"],
    config: DfoConfig,
    *,
    generator: torch.Generator,
) -> DfoResult:
    """Search for actions of low energy.

    Args:
        energy: Scores candidates.
        start: First candidates [-].
        config: Iterations, noise and final choice.
        generator: Source of chance, on the device of the candidates.

    Returns:
        The chosen actions, and the candidates and energies that they were chosen from.

    Reference:
        Algorithm 1 of the paper; tempered, annealed importance resampling of Del Moral et al., Sequential Monte
        Carlo Samplers, 2006.
    """
    candidates, sigma = start, config.sigma_init
    # n resamplings with exp(-E) leave about exp(-n E); with exp(-E / n) the product is exp(-E) again.
    temperature = float(config.iterations) if config.temper else 1.0
    energies = energy(candidates)
    for resampling in range(1, config.iterations):
        probabilities = torch.softmax(-energies / temperature, dim=1)
        drawn = draw_categorical(probabilities, candidates.shape[1], generator=generator)
        kept = pick(candidates, drawn)
        noise = torch.randn(kept.shape, generator=generator, device=kept.device)
        candidates = (kept + sigma * noise).clamp(-config.bound, config.bound)
        energies_kept, energies = energies.gather(1, drawn), energy(candidates)
        if config.temper:
            rise = (energies - energies_kept) * resampling / temperature
            accepted = _metropolis(rise, generator)
            candidates = torch.where(accepted[..., None], candidates, kept)
            energies = torch.where(accepted, energies, energies_kept)
        sigma *= config.shrink
    if config.choice == "argmin":
        chosen = energies.argmin(dim=1, keepdim=True)
    else:
        probabilities = torch.softmax(-energies / temperature, dim=1)
        chosen = draw_categorical(probabilities, 1, generator=generator)
    return DfoResult(pick(candidates, chosen).squeeze(1), candidates, energies)


def _metropolis(rise: Float[Tensor, "B N"], generator: torch.Generator) -> Bool[Tensor, "B N"]:
    """Whether to accept noise that raises the tempered energy by `rise` [nats].

    Without it the noise blurs what earlier resamplings chose, and the shares of two modes drift towards each other.
    """
    unit = torch.rand(rise.shape, generator=generator, device=rise.device)
    return unit < torch.exp(-rise)
