"""Draw indices by their probabilities: few in any order, or many in ascending order, which is much quicker."""

import torch
from jaxtyping import Float, Int
from torch import Tensor


def draw_categorical(
    probabilities: Float[Tensor, "B N"], num_draws: int, *, generator: torch.Generator
) -> Int[Tensor, "B S"]:
    """Draw indices with replacement by inverting the cumulative sum; quicker than torch.multinomial for many draws.

    Args:
        probabilities: Non-negative weights of the indices; they need not sum to one [-].
        num_draws: Draws for each row.
        generator: Source of chance, on the device of the probabilities.

    Returns:
        Indices into the second axis, each draw independent of the others.
    """
    unit = torch.rand(
        (len(probabilities), num_draws),
        generator=generator,
        device=probabilities.device,
        dtype=torch.float64,
    )
    return invert_cumulative(probabilities, unit)


def draw_ascending(
    probabilities: Float[Tensor, "B N"], num_draws: int, *, generator: torch.Generator
) -> Int[Tensor, "B S"]:
    """Draw indices as `draw_categorical` does, and return them sorted.

    How often each index comes up has the same (multinomial) distribution; only the order, which a population of
    candidates does not have, is lost. Neighbours in the cumulative sum are looked up one after the other, so that
    searching and gathering stay in the cache.

    Args:
        probabilities: Non-negative weights of the indices; they need not sum to one [-].
        num_draws: Draws for each row.
        generator: Source of chance, on the device of the probabilities.

    Returns:
        Indices into the second axis, ascending in each row.

    Reference:
        Devroye, Non-Uniform Random Variate Generation, 1986, chapter V.3.1: normalised sums of exponential spacings are
        distributed as sorted uniform numbers.
    """
    shape = (len(probabilities), num_draws + 1)
    unit = torch.rand(shape, generator=generator, device=probabilities.device)
    sums = unit.neg_().log1p_().neg_().cumsum(dim=1, dtype=torch.float64)
    return invert_cumulative(probabilities, sums[:, :-1] / sums[:, -1:])


def invert_cumulative(
    probabilities: Float[Tensor, "B N"], unit: Float[Tensor, "B S"]
) -> Int[Tensor, "B S"]:
    """Find the indices at which the cumulative sum passes shares of all there is.

    Args:
        probabilities: Non-negative weights of the indices; they need not sum to one [-].
        unit: Shares in [0, 1), in double precision [-].

    Returns:
        Indices into the second axis of the probabilities.
    """
    cumulative = probabilities.cumsum(dim=1, dtype=torch.float64)
    # side="right" skips indices of probability zero; the clamp meets a draw at the very end.
    drawn = torch.searchsorted(cumulative, unit * cumulative[:, -1:], right=True)
    return drawn.clamp_(max=probabilities.shape[1] - 1)


def pick(candidates: Float[Tensor, "B N 2"], indices: Int[Tensor, "B S"]) -> Float[Tensor, "B S 2"]:
    """Candidates [-] at some indices of each row."""
    num_rows = len(candidates)
    first = candidates.shape[1] * torch.arange(num_rows, device=indices.device)[:, None]
    flat = candidates.reshape(-1, 2).index_select(0, (indices + first).view(-1))
    return flat.view(num_rows, -1, 2)
