"""The convolutions over the bird's-eye view, and a quicker way to train them in bfloat16 on a CPU.

Layer sizes follow the XtMaCNN of Zhang et al., End-to-End Urban Driving by Imitating a Reinforcement Learning
Coach, ICCV 2021, which the authors of DA-IBC built their earlier agents on.
"""

import torch
from jaxtyping import Float, UInt8
from torch import Tensor, nn
from torch.nn import functional as F  # noqa: N812

BEV_CHANNELS = 5
# (channels out, kernel size, stride); no padding, ReLU after each.
LAYERS = ((8, 5, 2), (16, 5, 2), (32, 5, 2), (64, 3, 2), (128, 3, 2), (256, 3, 1))
FLAT_SIZE = 256 * 2 * 2
"""Numbers that are left of a picture of 192 x 192."""

_WHITE = 255.0


class Convolutions(nn.Sequential):
    """Six convolutions with ReLU, from a bird's-eye view to `FLAT_SIZE` numbers."""

    def __init__(self) -> None:
        layers: list[nn.Module] = []
        channels = BEV_CHANNELS
        for channels_out, kernel_size, stride in LAYERS:
            convolution = nn.Conv2d(channels, channels_out, kernel_size, stride)
            nn.init.xavier_uniform_(convolution.weight, gain=nn.init.calculate_gain("relu"))
            nn.init.constant_(convolution.bias, 0.1)  # type: ignore[arg-type]
            layers += [convolution, nn.ReLU()]
            channels = channels_out
        super().__init__(*layers, nn.Flatten())
        # Channels last: half the time of a training step in bfloat16 on a CPU with AMX.
        self.to(memory_format=torch.channels_last)  # type: ignore[call-overload]

    def forward(  # type: ignore[override]  # Sequential takes no number format
        self, bev: UInt8[Tensor, "B 5 192 192"], dtype: torch.dtype
    ) -> Float[Tensor, "B F"]:
        """Look at pictures.

        Args:
            bev: Bird's-eye views in 0..255 [-].
            dtype: Number format of the pixels.

        Returns:
            What is left of each [-].
        """
        is_trained = torch.is_grad_enabled() and bev.device.type == "cpu"
        if is_trained and dtype == torch.bfloat16:
            return self.in_blocks(bev, dtype)
        x: Tensor = bev.contiguous(memory_format=torch.channels_last).to(dtype).mul_(1 / _WHITE)
        for layer in self:
            x = layer(x)
        return x

    def in_blocks(
        self, bev: UInt8[Tensor, "B 5 192 192"], dtype: torch.dtype
    ) -> Float[Tensor, "B F"]:
        """The same, but for rounding, with the first two layers as convolutions of stride 1 over blocks of pixels.

        Few channels leave a CPU's matrix units idle, and strides cost copies: the first layer takes blocks of 4 x 4 pixels as
        80 channels to blocks of 2 x 2 of its own as 32, which the second takes as they are. The last is one product of matrices.
        """
        first, second, *others, last = (it for it in self if isinstance(it, nn.Conv2d))
        assert first.bias is not None
        weight = _as_blocks_of_4(first.weight) * (1 / _WHITE)
        blocks = _blocks_of_4(bev).to(dtype).permute(0, 3, 1, 2)  # (B, 80, 48, 48)
        x = _convolved(blocks, weight, first.bias.repeat(4))  # (B, 32, 47, 47)
        x = _convolved(x, _as_blocks_of_2(second.weight), second.bias)  # (B, 16, 45, 45)
        for convolution in others:
            x = F.relu(convolution(x))
        return _product(x, last).flatten(1)


def _convolved(
    x: Float[Tensor, "B C H W"], weight: Float[Tensor, "K C M N"], bias: Float[Tensor, " K"] | None
) -> Float[Tensor, "B K I J"]:
    return F.relu(F.conv2d(x, weight.contiguous(memory_format=torch.channels_last), bias))


def _blocks_of_4(bev: UInt8[Tensor, "B C H W"]) -> UInt8[Tensor, "B I J D"]:
    """Blocks of 4 x 4 pixels as channels: picture channel, row, column; four pixels of a row are moved at once."""
    fours = bev.contiguous().view(torch.int32)  # (B, C, H, W / 4)
    blocks = fours.unflatten(2, (-1, 4)).permute(0, 2, 4, 1, 3)  # (B, H / 4, W / 4, C, 4)
    return blocks.contiguous().view(torch.uint8).flatten(3)


def _as_blocks_of_4(weight: Float[Tensor, "K C 5 5"]) -> Float[Tensor, "L D 2 2"]:
    """Weights of stride 2 over pixels as weights from blocks of 4 x 4 pixels to blocks of 2 x 2 results."""
    moved = [
        F.pad(weight, (2 * column, 3 - 2 * column, 2 * row, 3 - 2 * row))  # 5 x 5 within 8 x 8
        for row in (0, 1)
        for column in (0, 1)
    ]
    stacked = torch.cat(moved).unflatten(3, (2, 4)).unflatten(2, (2, 4))  # (4 K, C, 2, 4, 2, 4)
    return stacked.permute(0, 1, 3, 5, 2, 4).flatten(1, 3)


def _as_blocks_of_2(weight: Float[Tensor, "K C 5 5"]) -> Float[Tensor, "K D 3 3"]:
    """Weights of stride 2 over pixels as weights of stride 1 over their blocks of 2 x 2: row, column, channel."""
    padded = F.pad(weight, (0, 1, 0, 1)).unflatten(3, (3, 2)).unflatten(2, (3, 2))
    return padded.permute(0, 3, 5, 1, 2, 4).flatten(1, 3)


def _product(x: Float[Tensor, "B C H W"], layer: nn.Conv2d) -> Float[Tensor, "B K I J"]:
    """A small convolution of stride 1 as one product of matrices: its windows times its weights, and ReLU."""
    height, width = layer.kernel_size
    rows = x.permute(0, 2, 3, 1)
    num_rows, num_columns = x.shape[2] - height + 1, x.shape[3] - width + 1
    windows = torch.cat(
        [
            rows[:, row : row + num_rows, column : column + num_columns]
            for row in range(height)
            for column in range(width)
        ],
        dim=3,
    )
    weight = layer.weight.permute(0, 2, 3, 1).flatten(1)
    return F.relu(F.linear(windows, weight, layer.bias)).permute(0, 3, 1, 2)
