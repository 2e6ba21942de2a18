"""Exact choice on a grid: two action components are few enough to score every one."""

from collections.abc import Callable

import torch
from jaxtyping import Float
from torch import Tensor

from models.config import GridConfig
from models.samplers.commitment import Commitment
from models.samplers.dfo import EnergyFunction
from models.samplers.draws import draw_categorical


def action_grid(points: int, *, device: torch.device | None = None) -> Float[Tensor, "N 2"]:
    """Every pair of `points` evenly spaced accelerations and steerings in [-1, 1], acceleration outermost.

    Args:
        points: Points along each axis; an odd number has zero among them.
        device: Where the grid lies.

    Returns:
        points ** 2 actions [-].
    """
    axis = torch.linspace(-1.0, 1.0, points, device=device)
    return torch.cartesian_prod(axis, axis)


def choose(
    energy: EnergyFunction,
    config: GridConfig,
    *,
    generator: torch.Generator,
    commitment: Commitment | None = None,
    on_energies: Callable[[Tensor], None] | None = None,
) -> Float[Tensor, "B 2"]:
    """Choose a grid point for each observation: the lowest, or one drawn from exp(-E / temperature).

    Args:
        energy: Scores candidates.
        config: Grid, choice and temperature.
        generator: Source of chance; the grid lies on its device.
        commitment: What lasts from decision to decision; None draws among all points.
        on_energies: Shown the energies of all points, shape (B, N) [nats], to look at the choice.

    Returns:
        Acceleration and steering [-].
    """
    actions = action_grid(config.points, device=generator.device)
    energies = energy(actions[None])  # (B, N)
    if on_energies is not None:
        on_energies(energies)
    if config.choice == "argmin":
        return actions[energies.argmin(dim=1)]
    return draw_points(-energies / config.temperature, generator=generator, commitment=commitment)


def draw_points(
    log_weights: Float[Tensor, "B N"],
    *,
    generator: torch.Generator,
    commitment: Commitment | None,
) -> Float[Tensor, "B 2"]:
    """Draw one point of a square grid for each observation.

    Args:
        log_weights: Of each point, acceleration outermost, up to a constant of each row [nats].
        generator: Source of chance, on their device.
        commitment: What lasts from decision to decision; None draws among all points.

    Returns:
        Acceleration and steering [-].
    """
    if commitment is None:
        drawn = draw_categorical(torch.softmax(log_weights, dim=1), 1, generator=generator)
    else:
        drawn = commitment.draw(log_weights)
    actions = action_grid(round(log_weights.shape[1] ** 0.5), device=log_weights.device)
    return actions[drawn.squeeze(1)]
