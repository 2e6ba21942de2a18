"""Where the task and the methods meet: demonstrations in, a learner that acts out.

Shape letters everywhere in this package: B batch, N candidates or negatives, D demonstrations.
"""

from abc import ABC, abstractmethod
from typing import NamedTuple, Protocol, runtime_checkable

import torch
from jaxtyping import Float, Int, UInt8
from torch import Tensor, nn

from models.config import LearnerConfig
from models.samplers.commitment import Commitment

ACTION_SIZE = 2
ACTION_BOUND = 1.0


class Batch(NamedTuple):
    """Observations and what the expert did.

    Attributes:
        bev: Bird's-eye views, shape (B, 5, 192, 192), uint8 in 0..255 [-].
        state: Speed [m/s], previous acceleration [-] and previous steering [-], shape (B, 3).
        actions: Acceleration and steering in [-1, 1], shape (B, 2) [-].
    """

    bev: Tensor
    state: Tensor
    actions: Tensor

    def to(self, device: torch.device) -> "Batch":
        """The same batch on another device."""
        return Batch(*(tensor.to(device, non_blocking=True) for tensor in self))


class Chance(NamedTuple):
    """What chance decides about a minibatch; None where it decides nothing.

    It is drawn for the whole minibatch, so that processes which train on parts of it have the same negatives.

    Attributes:
        keeps_previous: Whether each observation keeps its previous action, shape (B, 1).
        label_noise: Added to each action, shape (B, 2) [-].
        negatives: Actions to tell each expert action apart from, shape (B, N, 2) [-].
        chain_noise: Standard normal numbers for the S steps of chains that make negatives, shape (B, S, N, 2) [-].
        pool: Expert actions that the negatives were made from, for all observations alike, shape (P, 2) [-].
        noise: What an action is mixed with to be denoised, shape (B, N, 2) [-].
        times: How far it is mixed, from 0 to 1, shape (B, N) [-].
    """

    keeps_previous: Tensor | None = None
    label_noise: Tensor | None = None
    negatives: Tensor | None = None
    chain_noise: Tensor | None = None
    pool: Tensor | None = None
    noise: Tensor | None = None
    times: Tensor | None = None

    def part(self, rows: slice) -> "Chance":
        """What of it concerns some observations."""

        def own(tensor: Tensor | None) -> Tensor | None:
            return None if tensor is None else tensor[rows]

        return Chance(
            keeps_previous=own(self.keeps_previous),
            label_noise=own(self.label_noise),
            negatives=own(self.negatives),
            chain_noise=own(self.chain_noise),
            pool=self.pool,
            noise=own(self.noise),
            times=own(self.times),
        )


@runtime_checkable
class Demonstrations(Protocol):
    """What the expert did, by index."""

    def __len__(self) -> int:
        """Number of observation-action pairs."""

    @property
    def actions(self) -> Tensor:
        """Every action, in order of index, shape (D, 2) [-]."""

    @property
    def states(self) -> Tensor:
        """Every speed [m/s], previous acceleration and previous steering [-], in order of index, shape (D, 3)."""

    def batch(self, indices: Tensor) -> Batch:
        """The pairs at some indices, in their order."""


class TensorDemonstrations:
    """Demonstrations that lie ready in memory."""

    def __init__(self, data: Batch) -> None:
        self._data = data

    def __len__(self) -> int:
        return len(self._data.actions)

    @property
    def actions(self) -> Float[Tensor, "D 2"]:
        """Every action, in order of index, shape (D, 2) [-]."""
        return self._data.actions

    @property
    def states(self) -> Float[Tensor, "D 3"]:
        """Every speed [m/s], previous acceleration and previous steering [-], in order of index."""
        return self._data.state

    def batch(self, indices: Int[Tensor, " B"]) -> Batch:
        """The pairs at some indices, in their order."""
        return Batch(*(tensor[indices] for tensor in self._data))


class Learner(nn.Module, ABC):
    """A network with its loss and its way to choose an action."""

    config: LearnerConfig

    def prepare(self, actions: Float[Tensor, "D 2"], density: Float[Tensor, " D"]) -> None:
        """Look at all expert actions once, before training; by default nothing is kept.

        Args:
            actions: Every expert action trained on [-].
            density: Kernel density estimate at each of them [-].
        """

    @abstractmethod
    def draw(self, actions: Float[Tensor, "B 2"], *, generator: torch.Generator) -> Chance:
        """Draw all that chance decides about a minibatch.

        Args:
            actions: Expert actions of the minibatch [-].
            generator: Source of negatives, noise and dropout, on the device of the actions.

        Returns:
            What `loss` takes.
        """

    @abstractmethod
    def loss(
        self, batch: Batch, chance: Chance, *, weights: Float[Tensor, " B"] | None
    ) -> Float[Tensor, ""]:
        """Mean loss over a minibatch or a part of it.

        Args:
            batch: Observations and expert actions.
            chance: What `draw` gave for them.
            weights: Factor on the loss of each pair [-]; None weighs all alike.

        Returns:
            A scalar to descend on [nats].
        """

    @abstractmethod
    def act(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        *,
        generator: torch.Generator,
        commitment: Commitment | None = None,
    ) -> Float[Tensor, "B 2"]:
        """Choose one action for each observation.

        Args:
            bev: Bird's-eye views in 0..255 [-].
            state: Speed [m/s], previous acceleration [-] and previous steering [-].
            generator: Source of chance, on the device of the observations.
            commitment: What lasts from decision to decision, of as many drivers as there are observations; it goes on with each call.
                None draws everything anew. Without effect on methods that do not sample from a density, and on searches and chains.

        Returns:
            Acceleration and steering in [-1, 1] [-].
        """

    @abstractmethod
    def log_density(
        self,
        bev: UInt8[Tensor, "B C H W"],
        state: Float[Tensor, "B 3"],
        actions: Float[Tensor, "A N 2"],
    ) -> Float[Tensor, "B N"]:
        """How probable actions are, for landscapes and for the likelihood of held-out actions.

        Args:
            bev: Bird's-eye views in 0..255 [-].
            state: Speed [m/s], previous acceleration [-] and previous steering [-].
            actions: Actions for each observation, or one set (A = 1) that all observations share [-].

        Returns:
            Log of the density given each observation, up to a constant of each observation, in single precision [nats].
        """


def weighted_mean(
    losses: Float[Tensor, " B"], weights: Float[Tensor, " B"] | None
) -> Float[Tensor, ""]:
    """Mean of the losses of a batch [nats], each first multiplied by its weight [-] where there are any."""
    return losses.mean() if weights is None else (losses * weights).mean()
