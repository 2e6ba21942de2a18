"""The cells of a square grid of actions: how large they are, which one an action lies in, and how it is spread over them.

The cell of a point reaches halfway to its neighbours; those at the ends reach inwards only.
"""

import torch
from jaxtyping import Float, Int
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from models.interfaces import ACTION_BOUND


def cell_widths(points: int, *, device: torch.device) -> Float[Tensor, " P"]:
    """Width of the cell of each point along an axis [-]."""
    widths = torch.full((points,), 2 * ACTION_BOUND / (points - 1), device=device)
    widths[[0, -1]] /= 2
    return widths


def cell_areas(points: int, *, device: torch.device) -> Float[Tensor, " N"]:
    """Area of the cell of each point of the grid, acceleration outermost [-]."""
    widths = cell_widths(points, device=device)
    return torch.outer(widths, widths).flatten()


def nearest_points(actions: Float[Tensor, "*B 2"], *, points: int) -> Int[Tensor, "*B 2"]:
    """Index of the nearest point along each axis."""
    share = (actions + ACTION_BOUND) / (2 * ACTION_BOUND)
    return (share * (points - 1)).round().long().clamp(0, points - 1)


def spread_over_cells(
    actions: Float[Tensor, "*B 2"], *, points: int, deviation: float
) -> Float[Tensor, "*B 2 P"]:
    """Spread each action over the cells along each axis.

    Args:
        actions: In [-1, 1] [-].
        points: Points along an axis.
        deviation: Standard deviation of the Gaussian, which is cut off at the ends; 0 gives all to the nearest point [-].

    Returns:
        Probability of the cell of each point; the product over both axes is that of the pair [-].
    """
    if deviation == 0:
        return F.one_hot(nearest_points(actions, points=points), points).to(actions.dtype)
    axis = torch.linspace(-ACTION_BOUND, ACTION_BOUND, points, device=actions.device)
    exponents = -0.5 * ((axis - actions[..., None]) / deviation).square()
    return torch.softmax(exponents + cell_widths(points, device=actions.device).log(), dim=-1)
