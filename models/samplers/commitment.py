"""Choices between left, straight on and right that last for a while, without a change of what is chosen at each moment."""

import torch
from jaxtyping import Float, Int
from torch import Tensor

from models.samplers.draws import draw_categorical

NUM_SIDES = 3
"""Right, straight on and left."""


def draw_sides(num_observations: int, *, generator: torch.Generator) -> Float[Tensor, "B 3"]:
    """Gumbel noise, from which `draw_committed` chooses a side; as long as it lasts, so does the choice.

    Args:
        num_observations: How many choose.
        generator: Source of chance; the noise lies on its device.

    Returns:
        Noise of right, straight on and left [nats].
    """
    waiting = torch.empty(num_observations, NUM_SIDES, device=generator.device)
    return -waiting.exponential_(generator=generator).log()


def draw_committed(
    log_weights: Float[Tensor, "B N"],
    sides: Float[Tensor, "B 3"],
    *,
    split: float,
    generator: torch.Generator,
) -> Int[Tensor, "B 1"]:
    """Draw points of a square grid of actions: first a side, by noise that may last, then one of its points.

    With fresh noise each point is drawn by its weight (Gumbel-max, then a draw among what is left). All points of a mode are on
    one side, so a distribution with one mode is drawn from as if nothing lasted.

    Args:
        log_weights: Log weight of each point, acceleration outermost, up to a constant of each row [nats].
        sides: What `draw_sides` gave, now or earlier.
        split: A mode is on the side to which its densest point steers by more than that, else straight on [-].
        generator: Source of the draw on a side.

    Returns:
        Indices into the second axis.

    Reference:
        Gumbel, Statistical Theory of Extreme Values, 1954: the largest of log weights plus Gumbel noise has the weights' odds.
    """
    points = round(log_weights.shape[1] ** 0.5)
    steering = torch.linspace(-1.0, 1.0, points, device=log_weights.device)[
        modes(log_weights) % points
    ]
    side = 1 + (steering > split).long() - (steering < -split).long()  # (B, N)
    weights = torch.softmax(log_weights, dim=1)
    mass = torch.zeros_like(sides).scatter_add_(1, side, weights)
    chosen = (mass.log() + sides).argmax(dim=1, keepdim=True)
    return draw_categorical(weights * (side == chosen), 1, generator=generator)


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
