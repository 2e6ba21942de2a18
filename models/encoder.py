"""The observation encoder: a convolutional network over the bird's-eye view beside an MLP over the state."""

import torch
from jaxtyping import Bool, Float, UInt8
from torch import Tensor, nn

from models.config import STATE_INPUTS, NetworkConfig
from models.convolutions import FLAT_SIZE, Convolutions

HIDDEN_SIZE = 256

_LIGHTS_NOW = (0, 1, 4, 4, 4)
"""Channels of a view whose lights have no history: road, lane lines, and three times the newest lights, which come last."""


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


def policy_head(feature_size: int) -> nn.Sequential:
    """Two hidden layers between the features and what an explicit policy says of actions."""
    return nn.Sequential(
        nn.Linear(feature_size, HIDDEN_SIZE),
        nn.ReLU(),
        nn.Linear(HIDDEN_SIZE, HIDDEN_SIZE),
        nn.ReLU(),
    )


class Encoder(nn.Module):
    """Turns an observation into one feature vector of `feature_size` numbers."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self._sees_light_history = config.light_history
        self.image = Convolutions()
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
        if not self._sees_light_history:
            bev = bev[:, _LIGHTS_NOW]
        image = self.projection(self.image(bev, dtype))  # (B, 1024) or (B, 256)
        return self.joint(torch.cat((image, self.state(state * self.state_scale)), dim=1))
