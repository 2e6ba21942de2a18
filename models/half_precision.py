"""Weights in half the bytes, and what rounding them changes in what a policy chooses."""

from collections.abc import Mapping

import torch
from jaxtyping import Float, UInt8
from torch import Tensor

from models import expert_actions
from models.interfaces import Learner
from models.samplers.grid import action_grid
from models.threads import one_thread

POINTS = 65
"""Points along each action component at which distributions are compared; two of them lie 0.03 apart."""

KEPT = (expert_actions.STORED[1],)
"""Tensors that stay float32: rare actions have densities that float16 would make zero, and a search starts by their inverse."""


WORTH_IT = 4096
"""Numbers that a tensor must have to be rounded [-]; smaller ones save next to nothing and change most (docs/zoo.md)."""


def halved(tensors: Mapping[str, Tensor]) -> dict[str, Tensor] | None:
    """Round tensors from float32 to float16.

    Args:
        tensors: Weights by name; those of other types, small ones, and those of `KEPT`, stay as they are.

    Returns:
        The rounded ones; None if a number is too large for float16.
    """
    rounded = {
        name: tensor.half() if _is_rounded(name, tensor) else tensor
        for name, tensor in tensors.items()
    }
    overflows = any(not tensor.isfinite().all() for tensor in rounded.values())
    return None if overflows else rounded


def _is_rounded(name: str, tensor: Tensor) -> bool:
    return tensor.dtype == torch.float32 and tensor.numel() >= WORTH_IT and name not in KEPT


def widened(tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """Make float16 tensors float32 again; the numbers stay what they are."""
    return {
        name: tensor.float() if tensor.dtype == torch.float16 else tensor
        for name, tensor in tensors.items()
    }


@torch.no_grad()
def variations(
    one: Learner,
    other: Learner,
    bev: UInt8[Tensor, "B C H W"],
    state: Float[Tensor, "B 3"],
    *,
    points: int = POINTS,
) -> Float[Tensor, " B"]:
    """Total variation between what two learners would do at the same observations.

    It is the largest difference in probability that they give to any set of actions: who sees one action, of either,
    guesses which of the two it came from with a chance of (1 + variation) / 2 at best.

    Args:
        one: A learner.
        other: Another one.
        bev: Bird's-eye views in 0..255 [-].
        state: Speed [m/s], previous acceleration [-] and previous steering [-].
        points: Points along each action component of the grid that densities are compared on [-].

    Returns:
        From 0 (the same) to 1 at each observation [-].
    """
    grid = action_grid(points)[None]
    with one_thread():
        rows = [
            _distribution(one, seen[None], felt[None], grid)
            - _distribution(other, seen[None], felt[None], grid)
            for seen, felt in zip(bev, state, strict=True)
        ]
    return 0.5 * torch.cat(rows).abs().sum(dim=1)


def _distribution(learner: Learner, bev: Tensor, state: Tensor, grid: Tensor) -> Tensor:
    """Probabilities (1, N) of the actions of a grid (1, N, 2)."""
    return torch.softmax(learner.log_density(bev, state, grid).double(), dim=1)
