"""Where the task and the methods meet: demonstrations in, a learner that acts out.

Shape letters everywhere in this package: B batch, N candidates or negatives, D demonstrations.
"""

from abc import ABC, abstractmethod
from typing import NamedTuple, Protocol, runtime_checkable

import torch
from jaxtyping import Float, Int, UInt8
from torch import Tensor, nn

from models.config import LearnerConfig

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


@runtime_checkable
class Demonstrations(Protocol):
    """What the expert did, by index."""

    def __len__(self) -> int:
        """Number of observation-action pairs."""

    @property
    def actions(self) -> Tensor:
        """Every action, in order of index, shape (D, 2) [-]."""

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
    def loss(
        self, batch: Batch, *, weights: Float[Tensor, " B"] | None, generator: torch.Generator
    ) -> Float[Tensor, ""]:
        """Mean loss over a batch.

        Args:
            batch: Observations and expert actions.
            weights: Factor on the loss of each pair [-]; None weighs all alike.
            generator: Source of negatives and dropout, on the device of the batch.

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
    ) -> Float[Tensor, "B 2"]:
        """Choose one action for each observation.

        Args:
            bev: Bird's-eye views in 0..255 [-].
            state: Speed [m/s], previous acceleration [-] and previous steering [-].
            generator: Source of chance, on the device of the observations.

        Returns:
            Acceleration and steering in [-1, 1] [-].
        """


def weighted_mean(
    losses: Float[Tensor, " B"], weights: Float[Tensor, " B"] | None
) -> Float[Tensor, ""]:
    """Mean of the losses of a batch [nats], each first multiplied by its weight [-] where there are any."""
    return losses.mean() if weights is None else (losses * weights).mean()
