"""InfoNCE over the candidates of an energy head, a few observations at a time, forwards and backwards in one pass.

The hidden layers of 128 x 1025 candidates are 134 MB in bfloat16: written forwards, read backwards, from memory. But
the softmax of an observation needs no candidates but its own. So as soon as those are scored, the gradient goes back
through their hidden layers, which still lie in the cache, and nothing is kept but the gradients.
"""

import torch
from jaxtyping import Float
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import FunctionCtx, once_differentiable
from torch.nn import functional as F  # noqa: N812

from models.energy import EnergyHead
from models.interfaces import ACTION_SIZE, weighted_mean

# Candidates at a time. On a CPU their hidden layers stay in the cache of a core; a GPU wants large products.
ROWS_AT_A_TIME = {"cpu": 4200, "cuda": 131_200}


def info_nce(
    positive_energy: Float[Tensor, " B"], negative_energies: Float[Tensor, "B N"]
) -> Float[Tensor, " B"]:
    """Negative log-probability of the expert action among itself and its negatives.

    Args:
        positive_energy: Energy of the expert action [nats].
        negative_energies: Energies of its negatives [nats].

    Returns:
        The loss of each observation [nats].

    Reference:
        Florence et al., Implicit Behavioral Cloning, CoRL 2022, (2).
    """
    logits = -torch.cat((positive_energy[:, None], negative_energies), dim=1)  # (B, 1 + N)
    targets = torch.zeros(len(logits), dtype=torch.long, device=logits.device)
    return F.cross_entropy(logits, targets, reduction="none")


def contrastive_loss(
    head: EnergyHead,
    features: Float[Tensor, "B F"],
    candidates: Float[Tensor, "B N 2"],
    *,
    offsets: Float[Tensor, "B N"] | None = None,
    weights: Float[Tensor, " B"] | None = None,
) -> Float[Tensor, ""]:
    """Mean InfoNCE loss of candidates of which the first is the expert's.

    With gradients, equal to `info_nce` of `head(features, candidates)` but for rounding; the gradient of the last
    bias, which the softmax cancels, is exactly zero.

    Args:
        head: Gives the energies.
        features: One vector an observation [-].
        candidates: The expert action of each observation, then its negatives [-].
        offsets: Added to the energies before the softmax [nats].
        weights: Factor on the loss of each observation [-]; None weighs all alike.

    Returns:
        The mean over the observations [nats].
    """
    if not torch.is_grad_enabled():
        energies = head(features, candidates)
        energies = energies if offsets is None else energies + offsets
        return weighted_mean(info_nce(energies[:, 0], energies[:, 1:]), weights)
    observation_weight, action_weight = head.first.weight.split(
        [features.shape[1], ACTION_SIZE], dim=1
    )
    observed = F.linear(features, observation_weight, head.first.bias)  # (B, H)
    # One matrix an observation takes (acceleration, steering, 1) to the first hidden layer.
    first = torch.cat(
        (action_weight.T.expand(len(features), -1, -1), observed[:, None].float()), dim=1
    )  # (B, 3, H)
    scales = features.new_full((len(features),), 1 / len(features), dtype=torch.float32)
    scales = scales if weights is None else scales * weights
    inputs = F.pad(candidates, (0, 1), value=1.0).to(observed.dtype)  # (B, N, 3)
    weights_and_biases = [*head.second.parameters(), *head.last.parameters()]
    return _Contrast.apply(first, *weights_and_biases, inputs, offsets, scales)  # type: ignore[no-untyped-call]


class _Contrast(Function):
    """Sum of scaled InfoNCE losses, whose gradients are ready when the loss is."""

    @staticmethod
    def forward(  # noqa: PLR0917
        ctx: FunctionCtx,
        first: Tensor,
        second_weight: Tensor,
        second_bias: Tensor,
        last_weight: Tensor,
        last_bias: Tensor,
        inputs: Tensor,
        offsets: Tensor | None,
        scales: Tensor,
    ) -> Tensor:
        """Score, compare and go back, a few observations at a time."""
        layers = _Layers(
            first, (second_weight, second_bias), (last_weight, last_bias), dtype=inputs.dtype
        )
        losses = []
        chunk = max(1, ROWS_AT_A_TIME[inputs.device.type] // inputs.shape[1])
        with torch.autocast(inputs.device.type, enabled=False):
            for begin in range(0, len(inputs), chunk):
                part = slice(begin, begin + chunk)
                energies = layers.energies(inputs[part], part)
                logits = -energies if offsets is None else -(energies + offsets[part])
                normalisers = logits.logsumexp(dim=1, keepdim=True)
                losses.append((normalisers - logits[:, :1]).flatten())
                slopes = -torch.exp(logits - normalisers)  # of the loss, for each energy
                slopes[:, 0] += 1
                layers.descend(inputs[part], slopes * scales[part, None], part)
        ctx.save_for_backward(*layers.gradients())
        return (torch.cat(losses) * scales).sum()  # no matrix product, which would be autocast

    @staticmethod
    @once_differentiable
    def backward(ctx: FunctionCtx, gradient: Tensor) -> tuple[Tensor | None, ...]:
        """Hand out the gradients that `forward` collected."""
        gradients = [gradient * saved for saved in ctx.saved_tensors]  # type: ignore[attr-defined]
        return (*gradients, None, None, None)


class _Layers:
    """The layers of an energy head, what they hold for the observations at hand, and their gradients so far."""

    def __init__(
        self,
        first: Tensor,
        second: tuple[Tensor, Tensor],
        last: tuple[Tensor, Tensor],
        *,
        dtype: torch.dtype,
    ) -> None:
        self._first = first.to(dtype)
        self._second = second[0].to(dtype), second[1].to(dtype)
        self._last = last[0][0], last[1]
        # The slope of the energy one layer down, wherever hidden units are active.
        self._back = (last[0].T * second[0]).to(dtype)
        self._d_first = torch.empty_like(first)
        self._d_second, self._d_second_bias = map(torch.zeros_like, second)
        self._d_last = torch.zeros_like(self._last[0])
        self._hidden: tuple[Tensor, Tensor, Tensor] | None = None

    def energies(self, x: Tensor, part: slice) -> Tensor:
        """Energies (P, N) of candidates (P, N, 3); the hidden layers are kept until `descend`."""
        hidden_1 = torch.bmm(x, self._first[part]).relu_().flatten(0, 1)  # (P N, H)
        hidden_2 = F.linear(hidden_1, *self._second).relu_()
        # Energies differ by less than bfloat16 resolves.
        exact = hidden_2.float()
        self._hidden = hidden_1, hidden_2, exact
        weight, bias = self._last
        return (exact @ weight + bias).view(x.shape[:2])

    def descend(self, x: Tensor, slopes: Tensor, part: slice) -> None:
        """Add what slopes (P, N) of the loss mean for the weights; overwrites the hidden layers."""
        assert self._hidden is not None, "energies() comes first"
        hidden_1, hidden_2, exact = self._hidden
        self._hidden = None
        self._d_last += slopes.flatten() @ exact
        active = hidden_2.sign_()  # ReLU has left nothing below zero
        d_hidden_1 = torch.ops.aten.threshold_backward(active @ self._back, hidden_1, 0)
        slopes = slopes.to(x.dtype)[..., None]  # (P, N, 1)
        self._d_first[part] = (x * slopes).mT @ d_hidden_1.view(*x.shape[:2], -1)
        flat = slopes.flatten(0, 1)  # (P N, 1)
        self._d_second_bias += (active.T @ flat)[:, 0]
        self._d_second += active.T @ hidden_1.mul_(flat)

    def gradients(self) -> tuple[Tensor, ...]:
        """Of the five tensors that this was made from, in their order."""
        weight, bias = self._last
        return (
            self._d_first,
            self._d_second * weight[:, None],
            self._d_second_bias * weight,
            self._d_last[None],
            torch.zeros_like(bias),  # the softmax does not see it
        )
