"""Episodes -> tensors: every bird's-eye view is drawn once from the stored states and kept at one byte a pixel."""

from collections.abc import Callable, Sequence

import numpy as np
import torch
from jaxtyping import Float, Int, UInt8
from torch import Tensor

from mjdrive.bev import layers
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Episode, Town
from mjdrive.errors import DataError
from models.interfaces import Batch


class PackedDemonstrations:
    """Demonstrations as `models.interfaces.Demonstrations` wants them; 21,000 of them take 0.8 GB.

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
        strangers = {episode.town for episode in episodes} - {town.name}
        if strangers or not episodes:
            found = f"episodes of {', '.join(sorted(strangers))}" if strangers else "no episode"
            raise DataError(
                f"Found {found}; expected demonstrations in {town.name}. Collect them there."
            )
        self._codes = _draw(episodes, BevProjector(town), on_frame)
        self._table = _pair_table()
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
        bev = _unpack(self._codes[indices], self._table)
        return Batch(bev, self._states[indices], self._actions[indices])

    def to(self, device: torch.device) -> "PackedDemonstrations":
        """Move everything to a device, in place, so that batches are unpacked there."""
        self._codes = self._codes.to(device)
        self._table = self._table.to(device)
        self._states = self._states.to(device)
        self._actions = self._actions.to(device)
        return self


def states(episode: Episode) -> Float[np.ndarray, "T 3"]:
    """The state part of each observation: speed [m/s], previous acceleration and previous steering [-]."""
    previous = np.vstack([np.zeros((1, 2)), episode.actions[:-1]])
    return np.column_stack([episode.vehicle[:, 3], previous]).astype(np.float32)


def _draw(
    episodes: Sequence[Episode], projector: BevProjector, on_frame: Callable[[int], None] | None
) -> UInt8[Tensor, "D H W"]:
    size = projector.config.size_px
    codes = np.empty((sum(len(episode.time) for episode in episodes), size, size), np.uint8)
    index = 0
    for episode in episodes:
        for time, (x, y, yaw, *_) in zip(episode.time, episode.vehicle, strict=True):
            bev = projector.project(
                x=x, y=y, yaw=yaw, time=float(time), light_phase=episode.light_phase
            )
            codes[index] = layers.pack(bev)
            index += 1
            if on_frame is not None:
                on_frame(index)
    return torch.from_numpy(codes)


def _pair_table() -> UInt8[Tensor, "65536 10"]:
    """The channels of every two pixels that lie beside each other, by their codes read as one number of 16 bits.

    To look single pixels up takes almost three times as long.
    """
    table = torch.from_numpy(layers.unpack(np.arange(256, dtype=np.uint8)[:, None, None]))
    numbers = torch.arange(2**16, dtype=torch.int32).to(torch.int16)
    pairs = numbers.view(torch.uint8).view(-1, 2).int()  # in the order of bytes of this machine
    return table.flatten(1)[pairs].flatten(1)


def _unpack(
    codes: UInt8[Tensor, "B H W"], table: UInt8[Tensor, "65536 10"]
) -> UInt8[Tensor, "B 5 H W"]:
    """What `layers.unpack` does, on any device and, in memory, with the channels last as convolutions like it.

    Args:
        codes: Packed views of even width.
        table: From `_pair_table`, on their device.
    """
    pairs = codes.contiguous().view(torch.int16).flatten().int().bitwise_and_(0xFFFF)
    num_channels = table.shape[1] // 2
    # Not -1, which nobody can tell where there is no view.
    return table.index_select(0, pairs).view(*codes.shape, num_channels).permute(0, 3, 1, 2)
