"""Sums of Gaussians over the box of actions, on a lattice finer than they are, to be read off at any number of actions.

A Gaussian over two components is a product of two, so a sum of D of them on a G x G lattice is a product of two matrices: it
grows with D, where pairs of actions grow with its square.
"""

import math

import torch
from jaxtyping import Float, Float64
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from models.interfaces import ACTION_BOUND

# Between lattice points of a Gaussian the interpolated logarithm is off by 1 / (8 * 16^2), 0.0005 nats.
POINTS_A_KERNEL = 16
MOST_POINTS = 1025
# A standard deviation below this has fewer than 16 points [-].
NARROWEST = 2 * ACTION_BOUND * POINTS_A_KERNEL / (MOST_POINTS - 1)
CENTRES_AT_A_TIME = 4096
# Far from all kernels a density is nothing; its logarithm stays a number.
LEAST_DENSITY = 1e-300


def coordinates(kernel: float, device: torch.device) -> Float64[Tensor, " G"]:
    """Coordinates from -1 to 1 that are dense enough for kernels of a standard deviation [-]."""
    points = min(1 + math.ceil(2 * ACTION_BOUND * POINTS_A_KERNEL / kernel), MOST_POINTS)
    return torch.linspace(-ACTION_BOUND, ACTION_BOUND, points, dtype=torch.float64, device=device)


def mixture(
    axis: Float64[Tensor, " G"],
    centres: Float[Tensor, "D 2"],
    weights: Float[Tensor, " D"],
    *,
    spread: float,
) -> Float64[Tensor, "G G"]:
    """Density of Gaussians around centres.

    Args:
        axis: Coordinates of the lattice along either component [-].
        centres: Of the Gaussians [-].
        weights: Of the Gaussians; they need not sum to one [-].
        spread: Standard deviation along either component [-].

    Returns:
        Density at each point of the lattice [-].
    """
    total = axis.new_zeros(len(axis), len(axis))
    for part, part_weights in zip(
        centres.split(CENTRES_AT_A_TIME), weights.split(CENTRES_AT_A_TIME), strict=True
    ):
        rows, columns = (_kernels(axis, component, spread) for component in part.T)
        total.addmm_(rows * part_weights, columns.T)
    return total / weights.double().sum()


def mixture_along(
    axis: Float64[Tensor, " G"], centres: Float[Tensor, " D"], *, spread: float
) -> Float64[Tensor, " G"]:
    """Density of one-dimensional Gaussians around centres."""
    parts = centres.split(CENTRES_AT_A_TIME)
    sums = torch.stack([_kernels(axis, part, spread).sum(dim=1) for part in parts])
    return sums.sum(dim=0) / len(centres)


def read(
    surface: Float[Tensor, "C G G"], actions: Float[Tensor, "A N 2"]
) -> Float[Tensor, "C A N"]:
    """All channels of a surface at actions in [-1, 1] [nats]."""
    # grid_sample wants the index that runs fastest first.
    places = actions.flip(-1)[None] / ACTION_BOUND
    found = F.grid_sample(surface[None], places, padding_mode="border", align_corners=True)
    return found[0]


def _kernels(
    axis: Float64[Tensor, " G"], centres: Float[Tensor, " D"], spread: float
) -> Float64[Tensor, "G D"]:
    """One-dimensional Gaussian densities of standard deviation `spread` around centres [-]."""
    distances = (axis[:, None] - centres.double()) / spread
    return distances.square_().mul_(-0.5).exp_() / (spread * math.sqrt(2 * math.pi))
