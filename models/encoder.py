"""The observation encoder: a convolutional network over the bird's-eye view beside an MLP over the state.

Layer sizes follow the XtMaCNN of Zhang et al., End-to-End Urban Driving by Imitating a Reinforcement Learning
Coach, ICCV 2021, which the authors of DA-IBC built their earlier agents on.
"""

import torch
from jaxtyping import Bool, Float, UInt8
from torch import Tensor, nn
from torch.nn import functional as F  # noqa: N812

from models.config import STATE_INPUTS, NetworkConfig

BEV_CHANNELS = 5
# (channels out, kernel size, stride); no padding, ReLU after each.
CONVOLUTIONS = ((8, 5, 2), (16, 5, 2), (32, 5, 2), (64, 3, 2), (128, 3, 2), (256, 3, 1))
FLAT_SIZE = 256 * 2 * 2  # what is left of a 192 x 192 picture
HIDDEN_SIZE = 256


def draw_dropout(
    num_observations: int, probability: float, *, generator: torch.Generator
) -> Bool[Tensor, "B 1"] | None:
    """Choose the observations that lose their previous action, so that a learner cannot live by repeating it.

    Args:
        num_observations: How many to choose among.
        probability: Chance of each to lose it [-].
        generator: Source of chance; the choice lies on its device.

    Returns:
        Whether each keeps its previous action; None if all do.
    """
    if probability == 0:
        return None
    unit = torch.rand(num_observations, 1, generator=generator, device=generator.device)
    return unit >= probability


def drop_previous_action(
    state: Float[Tensor, "B 3"], kept: Bool[Tensor, "B 1"] | None
) -> Float[Tensor, "B 3"]:
    """Hide the previous action of some observations.

    Args:
        state: Speed [m/s], previous acceleration [-] and previous steering [-].
        kept: What `draw_dropout` gave.

    Returns:
        The state, with zeros for the previous actions that were dropped.
    """
    if kept is None:
        return state
    return torch.cat((state[:, :1], state[:, 1:] * kept), dim=1)


class BlockConv2d(nn.Conv2d):
    """A 5 x 5 convolution of stride 2, trained in bfloat16 as a 3 x 3 one of stride 1 over blocks of 2 x 2 pixels.

    The weights and, but for rounding, the results are those of `nn.Conv2d`; the gradient with respect to few
    input channels takes a tenth of the time on a CPU in bfloat16.
    """

    def forward(self, x: Float[Tensor, "B C H W"]) -> Float[Tensor, "B K I J"]:
        """Convolve a picture of even height and width."""
        pays = torch.is_grad_enabled() and x.device.type == "cpu" and x.dtype == torch.bfloat16
        return self.in_blocks(x) if pays else super().forward(x)

    def in_blocks(self, x: Float[Tensor, "B C H W"]) -> Float[Tensor, "B K I J"]:
        """The same convolution over blocks."""
        blocks = _blocks(x)
        weight = _blocks(F.pad(self.weight, (0, 1, 0, 1)))  # 6 x 6 with a zero edge -> 3 x 3
        return F.conv2d(blocks, weight, self.bias)


def _blocks(x: Float[Tensor, "B C H W"]) -> Float[Tensor, "B D I J"]:
    """Stack blocks of 2 x 2 pixels into channels; quicker than pixel_unshuffle where channels come last."""
    rows = x.permute(0, 2, 3, 1)  # (B, H, W, C)
    blocks = rows.unflatten(2, (-1, 2)).unflatten(1, (-1, 2)).permute(0, 1, 3, 2, 4, 5)
    return blocks.flatten(3).permute(0, 3, 1, 2)  # (B, 4 C, H / 2, W / 2)


def policy_head(feature_size: int) -> nn.Sequential:
    """Two hidden layers between the features and what an explicit policy says of actions."""
    return nn.Sequential(
        nn.Linear(feature_size, HIDDEN_SIZE),
        nn.ReLU(),
        nn.Linear(HIDDEN_SIZE, HIDDEN_SIZE),
        nn.ReLU(),
    )


def _convolutions() -> nn.Sequential:
    layers: list[nn.Module] = []
    channels = BEV_CHANNELS
    for index, (channels_out, kernel_size, stride) in enumerate(CONVOLUTIONS):
        kind = BlockConv2d if index == 1 else nn.Conv2d
        convolution = kind(channels, channels_out, kernel_size, stride)
        nn.init.xavier_uniform_(convolution.weight, gain=nn.init.calculate_gain("relu"))
        nn.init.constant_(convolution.bias, 0.1)  # type: ignore[arg-type]
        layers += [convolution, nn.ReLU()]
        channels = channels_out
    return nn.Sequential(*layers, nn.Flatten())


class Encoder(nn.Module):
    """Turns an observation into one feature vector of `feature_size` numbers."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        # Channels last: half the time of a training step in bfloat16 on a CPU with AMX.
        self.image = _convolutions().to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self.state = nn.Sequential(
            nn.Linear(len(STATE_INPUTS), HIDDEN_SIZE),
            nn.ReLU(),
            nn.Linear(HIDDEN_SIZE, HIDDEN_SIZE),
            nn.ReLU(),
        )
        self.projection: nn.Module = nn.Identity()
        self.joint: nn.Module = nn.Identity()
        if config.fusion == "roach":
            self.joint = nn.Sequential(
                nn.Linear(FLAT_SIZE + HIDDEN_SIZE, 512), nn.ReLU(), nn.Linear(512, 256), nn.ReLU()
            )
            self.feature_size = 256
        else:
            self.projection = nn.Sequential(nn.Linear(FLAT_SIZE, HIDDEN_SIZE), nn.ReLU())
            self.feature_size = 2 * HIDDEN_SIZE
        kept = [float(name in config.state_inputs) for name in STATE_INPUTS]
        scale = torch.tensor(kept) / torch.tensor([config.speed_scale, 1.0, 1.0])
        self.register_buffer("state_scale", scale, persistent=False)
        self.state_scale: Tensor

    def forward(
        self, bev: UInt8[Tensor, "B 5 192 192"], state: Float[Tensor, "B 3"]
    ) -> Float[Tensor, "B F"]:
        """Encode observations.

        Args:
            bev: Bird's-eye views in 0..255 [-].
            state: Speed [m/s], previous acceleration [-] and previous steering [-].

        Returns:
            One feature vector an observation [-].
        """
        device = bev.device.type
        dtype = (
            torch.get_autocast_dtype(device)
            if torch.is_autocast_enabled(device)
            else self.state_scale.dtype
        )
        pixels = bev.contiguous(memory_format=torch.channels_last).to(dtype).mul_(1 / 255)
        image = self.projection(self.image(pixels))  # (B, 1024) or (B, 256)
        return self.joint(torch.cat((image, self.state(state * self.state_scale)), dim=1))
