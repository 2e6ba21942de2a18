"""Derivative-free optimisation of an energy: score, resample, disturb, and score again (Algorithm 1 of the paper)."""

from collections.abc import Callable
from typing import NamedTuple

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from models.config import DfoConfig
from models.samplers.draws import draw_ascending, draw_categorical, pick

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


def search(
    energy: EnergyFunction,
    start: Float[Tensor, "B N 2"],
    config: DfoConfig,
    *,
    generator: torch.Generator,
    on_candidates: Callable[[Tensor], None] | None = None,
) -> DfoResult:
    """Search for actions of low energy.

    The candidates are a population without order: resampling returns them sorted by where they came from.

    Args:
        energy: Scores candidates.
        start: First candidates [-].
        config: Iterations, noise and final choice.
        generator: Source of chance, on the device of the candidates.
        on_candidates: Shown the candidates of each iteration, shape (B, N, 2) [-], to look at the search.

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
    if on_candidates is not None:
        on_candidates(candidates)
    for resampling in range(1, config.iterations):
        probabilities = torch.softmax(-energies / temperature, dim=1)
        drawn = draw_ascending(probabilities, candidates.shape[1], generator=generator)
        kept = pick(candidates, drawn)
        noise = torch.randn(kept.shape, generator=generator, device=kept.device)
        candidates = noise.mul_(sigma).add_(kept).clamp_(-config.bound, config.bound)
        energies_kept, energies = energies.gather(1, drawn), energy(candidates)
        if config.temper:
            rise = (energies - energies_kept) * resampling / temperature
            accepted = _metropolis(rise, generator)
            candidates = torch.where(accepted[..., None], candidates, kept)
            energies = torch.where(accepted, energies, energies_kept)
        if on_candidates is not None:
            on_candidates(candidates)
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
