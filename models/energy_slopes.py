"""Slopes of the energy along the action, in closed form: two matrix products forth, two back, and no autograd."""

import torch
from jaxtyping import Bool, Float
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from models.config import Precision
from models.energy import EnergyHead
from models.energy_scoring import resolved
from models.interfaces import ACTION_SIZE


class EnergySlopes:
    """dE/dy of some observations x at actions y.

    E = w ReLU(W ReLU(W_a y + W_x x + b) + c) + d has the slope W_a^T (s_1 * (W^T (s_2 * w))), where s_1 and s_2 are 1 for
    active hidden units and 0 for the others. s_1 and s_2 are constant almost everywhere. So what autograd makes of this
    expression is the gradient of the slope itself, as a gradient penalty needs it.

    Args:
        head: The energy; its weights are read now, with their gradients where those are enabled.
        features: One vector an observation, shape (B, F) [-].
        precision: Number format of the two large products; actions and first layer are float32. Not for use under
            autocast, which would round them too.
    """

    def __init__(
        self, head: EnergyHead, features: Float[Tensor, "B F"], precision: Precision = "float32"
    ) -> None:
        bfloat16 = resolved(precision, features.device) == "bfloat16"
        dtype = torch.bfloat16 if bfloat16 else torch.float32
        observation_weight, self._action_weight = head.first.weight.split(
            [features.shape[1], ACTION_SIZE], dim=1
        )
        with torch.no_grad():
            observed = F.linear(features.float(), observation_weight, head.first.bias)
            self._observed = observed[:, None]  # (B, 1, H)
            self._second = head.second.weight.to(dtype), head.second.bias.to(dtype)
        self._back = (head.last.weight.T * head.second.weight).to(dtype)  # (H, H)

    def __call__(self, actions: Float[Tensor, "B N 2"]) -> Float[Tensor, "B N 2"]:
        """Slopes at some actions of each observation [nats], for which the actions themselves get no gradient."""
        first_active, second_active = self._active_units(actions)
        slopes = (second_active.to(self._back.dtype) @ self._back).float()
        return (slopes * first_active) @ self._action_weight

    @torch.no_grad()
    def _active_units(
        self, actions: Float[Tensor, "B N 2"]
    ) -> tuple[Bool[Tensor, "B N H"], Bool[Tensor, "B N H"]]:
        """Which units of either hidden layer are above zero."""
        hidden = F.linear(actions, self._action_weight).add_(self._observed)
        first_active = hidden > 0
        return first_active, F.linear(hidden.relu_().to(self._back.dtype), *self._second) > 0
