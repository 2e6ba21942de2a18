"""How common an action is: Gaussian kernel density estimate, and the weights that even it out."""

import math

import torch
from jaxtyping import Float, Float64
from torch import Tensor

from models import lattice
from models.config import DensityConfig, DensityKind

# Rows of the kernel matrix held at a time.
ROWS_AT_A_TIME = 32


def kernel_density(
    points: Float[Tensor, "M A"],
    data: Float[Tensor, "D A"],
    *,
    bandwidth: float,
    kind: DensityKind,
) -> Float[Tensor, " M"]:
    """Estimate the density of data at some points, exactly, pair by pair.

    Args:
        points: Where to estimate [-].
        data: What was observed [-].
        bandwidth: Standard deviation h of the Gaussian kernel [-].
        kind: "joint" for one kernel over all components, "product" for the product of one-dimensional estimates.

    Returns:
        Density at each point [-].

    Reference:
        Silverman, Density Estimation for Statistics and Data Analysis, 1986, (4.1).
    """
    if kind == "product":
        densities = [
            kernel_density(points[:, [axis]], data[:, [axis]], bandwidth=bandwidth, kind="joint")
            for axis in range(points.shape[1])
        ]
        return torch.stack(densities).prod(dim=0)
    columns = (data / bandwidth).T.contiguous()
    sums = [_kernel_sums(part, columns) for part in (points / bandwidth).split(ROWS_AT_A_TIME)]
    normaliser = len(data) * (bandwidth * math.sqrt(2 * math.pi)) ** points.shape[1]
    return torch.cat(sums) / normaliser


def _kernel_sums(rows: Tensor, columns: Tensor) -> Tensor:
    """Sum of exp(-|row - column|^2 / 2) over the columns (A, D), for each of the rows (M, A)."""
    exponents = torch.zeros(len(rows), columns.shape[1], device=rows.device)
    for axis, column in enumerate(columns):
        difference = rows[:, axis, None] - column
        exponents.addcmul_(difference, difference, value=-0.5)
    return exponents.exp_().sum(dim=1)


def action_density(actions: Float[Tensor, "D 2"], config: DensityConfig) -> Float[Tensor, " D"]:
    """Density of each action among all of them, as the settings say [-].

    It is read off a lattice and off by less than 0.1 %: pair by pair it would be exact, and take a quarter of an hour for
    320,000 actions. Kernels that are too narrow for the lattice are summed pair by pair after all.

    Args:
        actions: In [-1, 1] [-].
        config: Kernel.
    """
    if config.bandwidth < lattice.NARROWEST:
        return kernel_density(actions, actions, bandwidth=config.bandwidth, kind=config.kind)
    axis = lattice.coordinates(config.bandwidth, actions.device)
    log_density = density_surface(axis, actions, config).log().float()
    return lattice.read(log_density[None], actions[None])[0, 0].exp()


def density_surface(
    axis: Float64[Tensor, " G"], actions: Float[Tensor, "D 2"], config: DensityConfig
) -> Float64[Tensor, "G G"]:
    """Density of actions on a lattice of given coordinates, nowhere zero [-]."""
    if config.kind == "joint":
        ones = torch.ones_like(actions[:, 0])
        density = lattice.mixture(axis, actions, ones, spread=config.bandwidth)
    else:
        rows, columns = (
            lattice.mixture_along(axis, component, spread=config.bandwidth)
            for component in actions.T
        )
        density = rows[:, None] * columns
    return density.clamp_min(lattice.LEAST_DENSITY)


def inverse_weights(density: Float[Tensor, " D"], config: DensityConfig) -> Float[Tensor, " D"]:
    """Weights that make rare actions count more: (1 / density) ** exponent, capped, of mean one.

    Args:
        density: Density at each action [-].
        config: Exponent and cap.

    Returns:
        Weights whose mean is one [-].
    """
    weights = density.reciprocal().pow(config.exponent)
    weights = weights / weights.mean()
    if config.cap is not None:
        weights = weights.clamp(max=config.cap)
    return weights / weights.mean()
