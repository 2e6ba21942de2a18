"""Energies of many candidate actions without gradients, in float32 or with hidden layers in bfloat16.

Both formats work on a piece of the candidates at a time, through all layers, so that what lies between layers never
leaves the cache. Threads share out the pieces, so the bytes of an energy do not hang on their number.
"""

from collections.abc import Callable

import torch
from jaxtyping import BFloat16, Float
from torch import Tensor
from torch.nn import functional as F  # noqa: N812

from models import hardware
from models.config import Precision, SamplerConfig
from models.energy import HIDDEN_SIZE, EnergyHead
from models.threads import for_each, one_thread

# Hidden layers of this many candidates are 0.5 MB (bfloat16) and 1 MB (float32).
ROWS_AT_A_TIME = 1024
# On a GPU there is nothing to keep in a cache, and every piece costs launches.
ROWS_AT_A_TIME_CUDA = 2**18
# In bfloat16 the hidden layer has units that are always 1, whose weights are the bias of the next layer: that is
# quicker than adding one. Two are needed; 16 fill the registers.
CONSTANT_UNITS = 16

Piece = tuple[Tensor, Tensor]
"""Rows of the first product, and where to write their energies."""

Score = Callable[[Piece], None]


def resolved(precision: Precision, device: torch.device | str = "cpu") -> Precision:
    """The number format that a setting means on a device.

    Args:
        precision: "auto" takes bfloat16 where the device is fast at it, and float32 elsewhere.
        device: Where energies are computed.

    Returns:
        "float32" or "bfloat16".
    """
    if precision != "auto":
        return precision
    return "bfloat16" if hardware.bfloat16_is_fast(device) else "float32"


def resolved_for(sampler: SamplerConfig, device: torch.device | str = "cpu") -> Precision:
    """The number format that a sampler scores candidates in on a device.

    Args:
        sampler: How actions are found. As `resolved`, but "auto" takes float32 for a grid on a CPU: by tiles
            (`models.grid_scoring`) that is quicker than bfloat16, and exact.
        device: Where energies are computed.

    Returns:
        "float32" or "bfloat16".
    """
    by_tiles = sampler.kind == "grid" and torch.device(device).type == "cpu"
    if sampler.precision == "auto" and by_tiles:
        return "float32"
    return resolved(sampler.precision, device)


class EnergyScorer:
    """E(x, y) of some observations x for as many candidates y as wanted.

    Args:
        head: The energy; its weights are read now.
        features: One vector an observation, shape (B, F) [-].
        precision: Number format of the hidden layers. With "bfloat16" the actions and the first layer still count to
            16 bits, and the last layer is float32.
        num_threads: Threads that share out the candidates; those that torch may use if None.
    """

    @torch.no_grad()
    def __init__(
        self,
        head: EnergyHead,
        features: Float[Tensor, "B F"],
        precision: Precision = "auto",
        *,
        num_threads: int | None = None,
    ) -> None:
        observation_weight, self._action_weight = head.first.weight.split(
            [features.shape[1], head.first.in_features - features.shape[1]], dim=1
        )
        with one_thread() as available:
            self._observed = F.linear(features, observation_weight, head.first.bias)  # (B, H)
        self._num_threads = num_threads or available
        self._second, self._last = head.second, head.last
        self.precision = resolved(precision, features.device)
        self._rows = ROWS_AT_A_TIME_CUDA if features.is_cuda else ROWS_AT_A_TIME

    @torch.no_grad()
    def __call__(self, candidates: Float[Tensor, "A N 2"]) -> Float[Tensor, "B N"]:
        """Score candidates.

        Args:
            candidates: Actions for each observation, or one set (A = 1) that all observations share [-].

        Returns:
            Energies, in single precision [nats].
        """
        energies = candidates.new_empty(len(self._observed), candidates.shape[1])
        scoring = self._in_bfloat16 if self.precision == "bfloat16" else self._in_float32
        with one_thread():
            for index, observed in enumerate(self._observed):
                actions = candidates[index if len(candidates) > 1 else 0]
                rows, worker = scoring(observed, actions)
                pieces = tuple(
                    zip(rows.split(self._rows), energies[index].split(self._rows), strict=True)
                )
                for_each(pieces, worker, num_threads=self._num_threads)
        return energies

    def _in_float32(self, observed: Tensor, actions: Tensor) -> tuple[Tensor, Callable[[], Score]]:
        """Rows of the first product for the actions (N, 2) of an observation (H), and who scores pieces of them."""
        first, second = self._action_weight.t(), self._second.weight.t()

        def worker() -> Score:
            hidden = actions.new_empty(2, min(self._rows, len(actions)), HIDDEN_SIZE)

            def score(piece: Piece) -> None:
                rows, energies = piece
                one, two = hidden[:, : len(rows)]
                torch.addmm(observed, rows, first, out=one).clamp_(min=0)
                torch.addmm(self._second.bias, one, second, out=two).clamp_(min=0)
                self._last_layer(two, energies)

            return score

        return actions, worker

    def _in_bfloat16(self, observed: Tensor, actions: Tensor) -> tuple[Tensor, Callable[[], Score]]:
        """As `_in_float32`; the sums inside a product are float32 all the same."""
        first = _split_first(self._action_weight, observed)
        second = _split_second(self._second.weight, self._second.bias)

        def worker() -> Score:
            num_rows = min(self._rows, len(actions))
            hidden = first.new_empty(num_rows, len(second))
            halves = first.new_empty(num_rows, HIDDEN_SIZE)
            singles = actions.new_empty(num_rows, HIDDEN_SIZE)

            def score(piece: Piece) -> None:
                rows, energies = piece
                one, two, single = (buffer[: len(rows)] for buffer in (hidden, halves, singles))
                _relu_(torch.mm(rows, first, out=one))
                _relu_(torch.mm(one, second, out=two))
                # Energies differ by less than bfloat16 resolves.
                self._last_layer(single.copy_(two), energies)

            return score

        return _split_actions(actions), worker

    def _last_layer(self, hidden: Tensor, energies: Tensor) -> None:
        """Write the energies (N) of hidden units (N, H), which are overwritten.

        A matrix-vector product would be as quick, but its bytes hang on the number of threads.
        """
        torch.sum(hidden.mul_(self._last.weight[0]), dim=1, out=energies)
        energies.add_(self._last.bias)


def _relu_(hidden: BFloat16[Tensor, "N H"]) -> None:
    """Rectify in place, as integers: the sign bit is the same, and torch needs a fifth of the time for it.

    A NaN with that bit would become 0; `checkpoint.load` refuses weights that make one.
    """
    hidden.view(torch.int16).clamp_(min=0)


def _parts(x: Tensor) -> tuple[Tensor, Tensor]:
    """A float32 number as the sum of two in bfloat16, the second of which is small: 16 of its 24 bits."""
    high = x.bfloat16()
    return high, (x - high).bfloat16()


def _split_actions(actions: Float[Tensor, "N 2"]) -> BFloat16[Tensor, "N 8"]:
    """Actions y as rows [high, low, high, 1, 1] for `_split_first`.

    Rounding y itself to bfloat16 would move a candidate by up to 0.002.
    """
    high, low = _parts(actions)
    ones = torch.ones_like(high[:1])
    # Both numbers of an action in bfloat16 are one integer of 32 bits, and integers are quicker to join.
    highs, lows, ones = (part.contiguous().view(torch.int32) for part in (high, low, ones))
    return torch.cat((highs, lows, highs, ones.expand(len(actions), 1)), dim=1).view(torch.bfloat16)


def _split_first(
    action_weight: Float[Tensor, "H 2"], observed: Float[Tensor, " H"]
) -> BFloat16[Tensor, "8 G"]:
    """Weights of the first layer: rows @ this = W_a y + W_x x, short only of the product of both low parts.

    The constant units behind it take the first of the two ones.
    """
    high, low = _parts(action_weight.t())
    units = torch.cat((high, high, low, torch.stack(_parts(observed))))  # (8, H)
    constant = units.new_zeros(len(units), CONSTANT_UNITS)
    constant[6] = 1
    return torch.cat((units, constant), dim=1)


def _split_second(
    weight: Float[Tensor, "H H"], bias: Float[Tensor, " H"]
) -> BFloat16[Tensor, "G H"]:
    """Weights of the second layer, then its bias in two parts for two of the constant units, and zeros."""
    rows = torch.cat((weight.t().bfloat16(), torch.stack(_parts(bias))))
    return F.pad(rows, (0, 0, 0, CONSTANT_UNITS - 2))
