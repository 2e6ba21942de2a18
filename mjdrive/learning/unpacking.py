"""Packed views -> the channels that a network takes, two pixels at a time, wherever they lie."""

import numpy as np
import torch
from jaxtyping import UInt8
from torch import Tensor

from mjdrive.bev import layers


def pair_table() -> UInt8[Tensor, "65536 10"]:
    """The channels of every two pixels that lie beside each other, by their codes read as one number of 16 bits.

    To look single pixels up takes almost three times as long.
    """
    table = torch.from_numpy(layers.unpack(np.arange(256, dtype=np.uint8)[:, None, None]))
    numbers = torch.arange(2**16, dtype=torch.int32).to(torch.int16)
    pairs = numbers.view(torch.uint8).view(-1, 2).int()  # in the order of bytes of this machine
    return table.flatten(1)[pairs].flatten(1)


def unpack(
    codes: UInt8[Tensor, "B H W"], table: UInt8[Tensor, "65536 10"]
) -> UInt8[Tensor, "B 5 H W"]:
    """What `layers.unpack` does, on any device and, in memory, with the channels last as convolutions like it.

    Args:
        codes: Packed views of even width.
        table: From `pair_table`, on their device.
    """
    pairs = codes.contiguous().view(torch.int16).flatten().int().bitwise_and_(0xFFFF)
    num_channels = table.shape[1] // 2
    # Not -1, which nobody can tell where there is no view.
    return table.index_select(0, pairs).view(*codes.shape, num_channels).permute(0, 3, 1, 2)
