"""Linear layers whose results for a single observation do not hang on the number of threads."""

import torch
from jaxtyping import Float
from torch import Tensor, nn
from torch.nn import functional as F  # noqa: N812


def steady_linear(
    x: Float[Tensor, "B I"], weight: Float[Tensor, "O I"], bias: Float[Tensor, " O"]
) -> Float[Tensor, "B O"]:
    """Product with a matrix; that of one row, without gradients and on a CPU, is done by one thread.

    A matrix times one vector is cut up among threads so that the rounding of each sum depends on their number (seen
    with 3, 5, 6 and 7 of them). Such a product takes a fraction of a millisecond, so nothing is lost; products of many
    rows are left to all threads.

    Args:
        x: Rows to multiply [-].
        weight: The matrix [-].
        bias: Is added [-].
    """
    num_threads = torch.get_num_threads()
    if len(x) != 1 or x.is_cuda or num_threads == 1 or torch.is_grad_enabled():
        return F.linear(x, weight, bias)
    torch.set_num_threads(1)
    try:
        return F.linear(x, weight, bias)
    finally:
        torch.set_num_threads(num_threads)


class SteadyLinear(nn.Linear):
    """`nn.Linear` that acts alike with any number of threads."""

    def forward(self, x: Float[Tensor, "B I"]) -> Float[Tensor, "B O"]:
        """See `steady_linear`."""
        return steady_linear(x, self.weight, self.bias)
