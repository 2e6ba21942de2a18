"""Episodes -> tensors: bird's-eye views are drawn again from the stored states, all at the start or each when it is needed."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np
import torch
from jaxtyping import Float, Int, UInt8
from torch import Tensor

from mjdrive.bev import layers
from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode, Town
from mjdrive.episodes.views import states
from mjdrive.errors import DataError
from mjdrive.learning.unpacking import pair_table, unpack
from models.interfaces import Batch

Views = Literal["auto", "memory", "live"]
"""Where the views are while one trains: all in memory, drawn when they are needed, or whichever suits their number."""

MOST_IN_MEMORY = 2**31
"""Views that would take more than this are drawn when they are needed, unless somebody says otherwise [byte]."""


class EpisodeDemonstrations(ABC):
    """Demonstrations as `models.interfaces.Demonstrations` wants them.

    Args:
        episodes: What the expert drove, all in one town.
        town: That town.

    Raises:
        DataError: If there is no episode, or one of another town.
    """

    def __init__(self, episodes: Sequence[Episode], town: Town) -> None:
        strangers = {episode.town for episode in episodes} - {town.name}
        if strangers or not episodes:
            found = f"episodes of {', '.join(sorted(strangers))}" if strangers else "no episode"
            raise DataError(
                f"Found {found}; expected demonstrations in {town.name}. Collect them there."
            )
        self._table = pair_table()
        self._states = torch.from_numpy(np.concatenate([states(episode) for episode in episodes]))
        labels = np.concatenate([episode.labels for episode in episodes])
        self._actions = torch.from_numpy(labels.astype(np.float32))

    def __len__(self) -> int:
        return len(self._actions)

    @property
    def actions(self) -> Float[Tensor, "D 2"]:
        """Every clean expert action: acceleration and steering [-]."""
        return self._actions

    @property
    def states(self) -> Float[Tensor, "D 3"]:
        """The state part of every observation: speed [m/s], previous acceleration and previous steering [-]."""
        return self._states

    def batch(self, indices: Int[Tensor, " B"]) -> Batch:
        """The pairs at some indices, in their order."""
        bev = unpack(self._packed(indices), self._table)
        return Batch(bev, self._states[indices], self._actions[indices])

    def to(self, device: torch.device) -> "EpisodeDemonstrations":
        """Move everything to a device, in place, so that batches are unpacked there."""
        self._table = self._table.to(device)
        self._states = self._states.to(device)
        self._actions = self._actions.to(device)
        return self

    @abstractmethod
    def _packed(self, indices: Int[Tensor, " B"]) -> UInt8[Tensor, "B H W"]:
        """Packed views at some indices, on the device of everything else."""


class PackedDemonstrations(EpisodeDemonstrations):
    """Every view is drawn at the start and kept at one byte a pixel: 21,000 of them take 0.8 GB.

    Args:
        episodes: What the expert drove, all in one town.
        town: That town.
        on_frame: Told the number of views drawn.

    Raises:
        DataError: If there is no episode, or one of another town.
    """

    def __init__(
        self,
        episodes: Sequence[Episode],
        town: Town,
        *,
        on_frame: Callable[[int], None] | None = None,
    ) -> None:
        super().__init__(episodes, town)
        self._codes = _drawn(BevProjector(town), _moments(episodes), on_frame)

    def to(self, device: torch.device) -> "EpisodeDemonstrations":
        """Move everything to a device, in place, so that batches are unpacked there."""
        self._codes = self._codes.to(device)
        return super().to(device)

    def _packed(self, indices: Int[Tensor, " B"]) -> UInt8[Tensor, "B H W"]:
        return self._codes[indices]


class LiveDemonstrations(EpisodeDemonstrations):
    """Every view is drawn when it is asked for, so that any number of them fits into memory.

    Args:
        episodes: What the expert drove, all in one town.
        town: That town.

    Raises:
        DataError: If there is no episode, or one of another town.
    """

    def __init__(self, episodes: Sequence[Episode], town: Town) -> None:
        super().__init__(episodes, town)
        self._projector = BevProjector(town)
        self._moments = _moments(episodes)

    def _packed(self, indices: Int[Tensor, " B"]) -> UInt8[Tensor, "B H W"]:
        return _drawn(self._projector, self._moments[indices.numpy()]).to(self._table.device)


def demonstrations_of(
    episodes: Sequence[Episode],
    town: Town,
    *,
    views: Views = "auto",
    on_frame: Callable[[int], None] | None = None,
) -> EpisodeDemonstrations:
    """Make demonstrations of episodes; what is learnt from them does not hang on where the views are.

    Args:
        episodes: What the expert drove, all in one town.
        town: That town.
        views: Where they are; "auto" keeps up to 2 GiB, 58,000 of them, in memory.
        on_frame: Told the number of views drawn at the start.

    Raises:
        DataError: If there is no episode, or one of another town.
    """
    total = sum(len(episode.time) for episode in episodes) * BevConfig().size_px ** 2
    if views == "memory" or (views == "auto" and total <= MOST_IN_MEMORY):
        return PackedDemonstrations(episodes, town, on_frame=on_frame)
    return LiveDemonstrations(episodes, town)


def _moments(episodes: Sequence[Episode]) -> Float[np.ndarray, "D 5"]:
    """Where the car was and when: x, y [m], yaw [rad], time and time into the light cycle at its zero [s]."""
    return np.concatenate(
        [
            np.column_stack(
                (
                    episode.vehicle[:, :3],
                    episode.time,
                    np.full_like(episode.time, episode.light_phase),
                )
            )
            for episode in episodes
        ]
    )


def _drawn(
    projector: BevProjector,
    moments: Float[np.ndarray, "B 5"],
    on_frame: Callable[[int], None] | None = None,
) -> UInt8[Tensor, "B H W"]:
    """Draw and pack the view of each moment."""
    size = projector.config.size_px
    codes = np.empty((len(moments), size, size), np.uint8)
    for index, (x, y, yaw, time, light_phase) in enumerate(moments.tolist()):
        bev = projector.project(x=x, y=y, yaw=yaw, time=time, light_phase=light_phase)
        codes[index] = layers.pack(bev)
        if on_frame is not None:
            on_frame(index + 1)
    return torch.from_numpy(codes)
