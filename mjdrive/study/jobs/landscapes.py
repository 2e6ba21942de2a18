"""What a policy thinks of all actions in a situation: its density over a grid of them, and what it draws from it.

Every method gives the log of its density (`Learner.log_density`), energies as -E with what their settings undo, so the
landscapes, modes and entropies of all methods mean the same.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float

from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Observation
from mjdrive.evaluation.landscape import Mode, entropy_bits, modes
from mjdrive.study.records.results import LandscapeRecord
from mjdrive.study.records.situations import Moment
from models.interfaces import Learner

POINTS = 128
"""Grid points along each action component [-]."""

NUM_DRAWS = 10
"""Actions that are drawn at each moment, as in the paper [-]."""


@dataclass(frozen=True, slots=True, eq=False)
class Landscape:
    """What a policy thinks of all actions in one situation.

    Attributes:
        probabilities: Of the points of an even grid over [-1, 1] x [-1, 1], acceleration outermost; they sum to one,
            shape (A, S) [-].
        draws: Actions that were drawn, each anew, shape (N, 2) [-].
    """

    probabilities: Float[np.ndarray, "A S"]
    draws: Float[np.ndarray, "N 2"]

    @property
    def modes(self) -> tuple[Mode, ...]:
        """Separate ways to act, the heaviest first."""
        return modes(self.probabilities)

    @property
    def entropy_bits(self) -> float:
        """Entropy over the grid [bit]."""
        return entropy_bits(self.probabilities)


def measure(
    learner: Learner,
    moments: Iterable[Moment],
    projector: BevProjector,
    *,
    seed: int,
    points: int = POINTS,
    num_draws: int = NUM_DRAWS,
    drawer: Learner | None = None,
) -> tuple[Landscape, ...]:
    """Ask a policy what it thinks in some situations.

    Args:
        learner: Trained network.
        moments: Where and when.
        projector: Draws what it sees there.
        seed: Decides the actions that it draws.
        points: Grid points along each action component [-].
        num_draws: Actions that are drawn at each moment [-].
        drawer: Who draws them, such as the same network with another way to act; the policy itself if None.

    Returns:
        One landscape a moment.
    """
    return tuple(
        landscape(
            learner,
            it.observe(projector),
            seed=seed,
            points=points,
            num_draws=num_draws,
            drawer=drawer,
        )
        for it in moments
    )


@torch.no_grad()
def landscape(
    learner: Learner,
    observation: Observation,
    *,
    seed: int,
    points: int = POINTS,
    num_draws: int = NUM_DRAWS,
    drawer: Learner | None = None,
) -> Landscape:
    """Ask a policy what it thinks of all actions, given one observation.

    Args:
        learner: Trained network.
        observation: What it sees.
        seed: Decides the actions that it draws.
        points: Grid points along each action component [-].
        num_draws: How many [-].
        drawer: Who draws them, each anew: nothing lasts from one to the next; the policy itself if None.
    """
    drawer = drawer or learner
    bev, state = _tensors(drawer, observation)
    generator = torch.Generator(bev.device).manual_seed(seed)
    draws = [drawer.act(bev, state, generator=generator)[0] for _ in range(num_draws)]
    return Landscape(
        probabilities=probabilities(learner, observation, points=points),
        draws=torch.stack(draws).double().cpu().numpy(),
    )


@torch.no_grad()
def probabilities(
    learner: Learner, observation: Observation, *, points: int = POINTS
) -> Float[np.ndarray, "A S"]:
    """What a policy thinks of all actions, given one observation.

    Args:
        learner: Trained network.
        observation: What it sees.
        points: Grid points along each action component [-].

    Returns:
        Probabilities of the points, acceleration outermost; they sum to one [-].
    """
    bev, state = _tensors(learner, observation)
    log_density = learner.log_density(bev, state, action_grid(points).to(bev.device)[None])
    return normalised(log_density[0].double().cpu().numpy().reshape(points, points))


def _tensors(learner: Learner, observation: Observation) -> tuple[torch.Tensor, torch.Tensor]:
    """An observation as a batch of one, where the learner is."""
    device = next(learner.parameters()).device
    return (
        torch.tensor(observation.bev, device=device)[None],
        torch.tensor(observation.state, device=device)[None],
    )


def action_grid(points: int) -> Float[torch.Tensor, "N 2"]:
    """Every action of an even grid, acceleration outermost [-]."""
    axis = torch.linspace(-1.0, 1.0, points)
    return torch.cartesian_prod(axis, axis)


def normalised(log_density: Float[np.ndarray, "A S"]) -> Float[np.ndarray, "A S"]:
    """Turn log densities, up to a constant [nats], into probabilities that sum to one."""
    weights = np.exp(log_density - log_density.max())
    return np.asarray(weights / weights.sum())


def from_record(record: LandscapeRecord) -> Landscape:
    """Take a landscape out of its record."""
    shape = (record.points, record.points)
    return Landscape(
        probabilities=np.array(record.probabilities).reshape(shape), draws=np.array(record.draws)
    )
