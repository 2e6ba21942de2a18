"""Steering that keeps to its place in the distribution for a while, and turns that are gone on with."""

import math

import torch
from jaxtyping import Float, Int
from torch import Tensor

from models.config import CommitmentConfig
from models.samplers.draws import draw_categorical, invert_cumulative

NUM_SIDES = 3
"""Right, straight on and left, in the order of steering."""

STRAIGHT_ON = 1
"""The side that nobody has to go on with."""


class Commitment:
    """What lasts from one decision to the next of one or more drivers.

    Args:
        config: How long; `hold` is at least 1.
        num_drivers: How many decide at once, each with chance of its own.
        generator: Source of chance; all that lasts lies on its device.
    """

    def __init__(
        self, config: CommitmentConfig, num_drivers: int, *, generator: torch.Generator
    ) -> None:
        self._config = config
        self._generator = generator
        self._noise = torch.randn(num_drivers, generator=generator, device=generator.device)
        self._side = torch.full((num_drivers, 1), STRAIGHT_ON, device=generator.device)

    def draw(self, log_weights: Float[Tensor, "B N"]) -> Int[Tensor, "B 1"]:
        """Draw points of a square grid of actions: a side, steering by its quantile there, then an acceleration that goes with it.

        As long as no turn has been begun, each point is drawn by its weight. The noise that says which quantile is taken lasts, so of
        two modes the same one is taken again, and a mode that splits is followed to the same side. Whoever steers to the left or to
        the right goes on with that side while it has the share `release` of the distribution, from its median where the
        noise would choose another one.

        Args:
            log_weights: Log weight of each point, acceleration outermost, up to a constant of each row [nats].

        Returns:
            Indices into the second axis.

        Reference:
            Nelsen, An Introduction to Copulas, 2006: where ranks are kept from one moment to the next, marginals are free.
        """
        points = round(log_weights.shape[1] ** 0.5)
        weights = torch.softmax(log_weights, dim=1)
        of_point = sides(log_weights, split=self._config.split)
        masses = torch.zeros_like(weights[:, :NUM_SIDES]).scatter_add_(1, of_point, weights)
        rank = torch.special.ndtr(self._noise.double())[:, None]
        side, share = self._choose_side(masses.double(), rank)
        here = torch.where(of_point == side, weights, 0).unflatten(1, (points, points))
        steering = invert_cumulative(here.sum(dim=1), share)  # (B, 1)
        column = here.gather(2, steering[:, None].expand(-1, points, 1)).squeeze(2)  # (B, points)
        acceleration = draw_categorical(column, 1, generator=self._generator)
        self._side = side
        self._go_on()
        return acceleration * points + steering

    def _choose_side(self, masses: Tensor, rank: Tensor) -> tuple[Tensor, Tensor]:
        """A side for each driver, and the share of it that steers further to the right, each (B, 1)."""
        wanted = invert_cumulative(masses, rank)
        is_kept = (self._side != STRAIGHT_ON) & (
            masses.gather(1, self._side) >= self._config.release * masses.sum(dim=1, keepdim=True)
        )
        side = torch.where(is_kept, self._side, wanted)
        before = masses.cumsum(dim=1) - masses
        share = (rank - before.gather(1, wanted)) / masses.gather(1, wanted)
        return side, torch.where(side == wanted, share, 0.5).clamp(0, 1)

    def _go_on(self) -> None:
        """Let the noise drift, a first-order autoregressive process; each value alone is standard normal.

        Reference:
            Uhlenbeck and Ornstein, On the theory of the Brownian motion, 1930.
        """
        kept = math.exp(-1.0 / self._config.hold)
        fresh = torch.randn(
            len(self._noise), generator=self._generator, device=self._generator.device
        )
        self._noise = kept * self._noise + math.sqrt(1.0 - kept**2) * fresh


def sides(log_weights: Float[Tensor, "B N"], *, split: float) -> Int[Tensor, "B N"]:
    """The side of each point of a square grid: that of the top of the mode that it belongs to.

    Args:
        log_weights: Height of each point, acceleration outermost [nats].
        split: Tops that steer by more are to the left, or to the right [-].

    Returns:
        0 to the right, 1 straight on, 2 to the left.
    """
    points = round(log_weights.shape[1] ** 0.5)
    axis = torch.linspace(-1.0, 1.0, points, device=log_weights.device)
    steering = axis[modes(log_weights) % points]
    return 1 + (steering > split).long() - (steering < -split).long()


def modes(log_weights: Float[Tensor, "B N"]) -> Int[Tensor, "B N"]:
    """The top of the mode that each point of a square grid belongs to: where one ends who climbs to the highest of eight neighbours.

    Args:
        log_weights: Height of each point [nats].

    Returns:
        Index of the top of each point; a point no lower than its neighbours is its own.
    """
    points = round(log_weights.shape[1] ** 0.5)
    height = log_weights.unflatten(1, (points, points))
    padded = torch.nn.functional.pad(height, (1, 1, 1, 1), value=-torch.inf)
    best, onward = height.clone(), torch.zeros_like(height, dtype=torch.long)
    for row in (-1, 0, 1):
        for column in (-1, 0, 1):
            other = padded[:, 1 + row : 1 + row + points, 1 + column : 1 + column + points]
            higher = other > best
            best = torch.where(higher, other, best)
            onward = torch.where(higher, row * points + column, onward)
    target = torch.arange(points**2, device=height.device) + onward.flatten(1)
    while True:
        further = target.gather(1, target)
        if torch.equal(further, target):
            return target
        target = further
