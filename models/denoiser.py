"""The network of the generative policies: a noisy action, its time and an observation in, a vector out.

Shape letters: B batch, N noisy actions of each observation, H hidden units.
"""

import math
from contextlib import AbstractContextManager, nullcontext

import torch
from jaxtyping import Float
from torch import Tensor, nn
from torch.nn import functional as F  # noqa: N812

from models.interfaces import ACTION_SIZE

NUM_FREQUENCIES = 8


class Denoiser(nn.Module):
    """MLP([feature, noisy action, time]) of three hidden layers, smooth so that its divergence can be integrated.

    The first layer is a sum of three products, of which that with the features is done once an observation. It is
    never autocast: a density is an integral over many evaluations, and bfloat16 would move actions by up to 0.004.
    """

    def __init__(self, feature_size: int, *, width: int, action_gain: float = 1.0) -> None:
        super().__init__()
        self.observation = nn.Linear(feature_size, width)
        self.action = nn.Linear(ACTION_SIZE, width, bias=False)
        with torch.no_grad():
            self.action.weight *= action_gain
        self.time = nn.Linear(1 + 2 * NUM_FREQUENCIES, width, bias=False)
        self.second = nn.Linear(width, width)
        self.third = nn.Linear(width, width)
        self.last = nn.Linear(width, ACTION_SIZE)

    def observe(self, features: Float[Tensor, "B F"]) -> Float[Tensor, "B 1 H"]:
        """What the observations [-] add to the first layer, to be handed to every evaluation [-]."""
        with _uncast(features.device):
            return self.observation(features.float())[:, None]

    def forward(
        self,
        observed: Float[Tensor, "B 1 H"],
        noisy: Float[Tensor, "B N 2"],
        times: Float[Tensor, "B N"] | float,
    ) -> Float[Tensor, "B N 2"]:
        """Evaluate the network.

        Args:
            observed: From `observe`.
            noisy: Noisy actions of each observation [-].
            times: Their times in [0, 1], or one for all [-].

        Returns:
            One vector an action, in single precision [-].
        """
        with _uncast(noisy.device):
            units = F.silu(self._first(observed, noisy, times))
            return self.last(F.silu(self.third(F.silu(self.second(units)))))

    def with_divergence(
        self, observed: Float[Tensor, "1 H"], noisy: Float[Tensor, "N 2"], time: float
    ) -> tuple[Float[Tensor, "N 2"], Float[Tensor, " N"]]:
        """Evaluate the network for one observation, and its divergence: the trace of its derivative by the action.

        The derivative by each of the two components runs along with the value, which is exact and needs no graph.

        Args:
            observed: From `observe`, of one observation.
            noisy: Noisy actions [-].
            time: Their time in [0, 1] [-].

        Returns:
            One vector an action [-], and the divergence there [-].
        """
        before = self._first(observed, noisy, time)
        # The value and its two derivatives, one below the other, so that a layer is one product.
        rows = torch.cat((before[None], self.action.weight.t()[:, None].expand(-1, *before.shape)))
        _bend_(rows)
        for layer in (self.second, self.third):
            rows = rows @ layer.weight.t()
            rows[0] += layer.bias
            _bend_(rows)
        # The derivative of a component by itself takes one row of the last layer each.
        divergence = (rows[1:] @ self.last.weight[:, :, None]).sum(dim=0).squeeze(1)
        return self.last(rows[0]), divergence

    def _first(self, observed: Tensor, noisy: Tensor, times: Tensor | float) -> Tensor:
        """The first layer before its bend."""
        times = torch.as_tensor(times, device=noisy.device, dtype=noisy.dtype)
        return observed + self.action(noisy) + self.time(_embedded(times))


def _uncast(device: torch.device) -> AbstractContextManager[object]:
    """Switch autocasting off where it is on; some devices have none."""
    if not torch.is_autocast_enabled(device.type):
        return nullcontext()
    return torch.autocast(device.type, enabled=False)


def _embedded(times: Float[Tensor, "*B"]) -> Float[Tensor, "*B E"]:
    """Times in [0, 1] as waves of growing frequency, so that a network tells near ones apart [-]."""
    frequencies = math.pi * torch.arange(1, NUM_FREQUENCIES + 1, device=times.device)
    angles = times[..., None] * frequencies
    return torch.cat((times[..., None], angles.sin(), angles.cos()), dim=-1)


def _bend_(rows: Float[Tensor, "3 N H"]) -> None:
    """Replace values by x * sigmoid(x), and the two derivatives below them by those of that."""
    sigmoid = rows[0].sigmoid()
    bent = rows[0].mul_(sigmoid)
    rows[1:] *= torch.addcmul(bent, sigmoid, 1 - bent)
