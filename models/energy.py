"""The energy of an action given an observation: an MLP whose observation part is computed once."""

import torch
from jaxtyping import Float
from torch import Tensor, nn
from torch.nn import functional as F  # noqa: N812

from models.interfaces import ACTION_SIZE

HIDDEN_SIZE = 256
# Without gradients, hidden layers of this many candidates at a time stay in the cache of a CPU core.
ROWS_AT_A_TIME = 4096


class EnergyHead(nn.Module):
    """E(x, y) = MLP([feature, action]), low where the action fits the observation [nats].

    The first layer is one matrix W = [W_x W_a] on the joined vector, applied as W_x x + W_a y: the large product is
    done once an observation, and the candidates cost a product with two columns each.
    """

    def __init__(self, feature_size: int, *, action_gain: float = 1.0) -> None:
        super().__init__()
        self.first = nn.Linear(feature_size + ACTION_SIZE, HIDDEN_SIZE)
        # Beside 256 features an action moves no hidden unit across its hinge: the energy starts as good as linear in
        # it, and stays so for long. Larger first weights spread the hinges over the box of actions.
        with torch.no_grad():
            self.first.weight[:, feature_size:] *= action_gain
        self.second = nn.Linear(HIDDEN_SIZE, HIDDEN_SIZE)
        self.last = nn.Linear(HIDDEN_SIZE, 1)

    def forward(
        self, features: Float[Tensor, "B F"], actions: Float[Tensor, "A N 2"]
    ) -> Float[Tensor, "B N"]:
        """Energies of candidate actions.

        Args:
            features: One vector an observation [-].
            actions: Candidates of each observation, or one set (A = 1) that all observations share [-].

        Returns:
            Energies, in single precision [nats].
        """
        observation_weight, action_weight = self.first.weight.split(
            [features.shape[1], ACTION_SIZE], dim=1
        )
        observed = F.linear(features, observation_weight, self.first.bias)[:, None]  # (B, 1, H)
        if torch.is_grad_enabled():
            return self._energies(observed, actions, action_weight)
        chunk = max(1, ROWS_AT_A_TIME // len(features))
        parts = [
            self._energies(observed, part, action_weight) for part in actions.split(chunk, dim=1)
        ]
        return torch.cat(parts, dim=1)

    def _energies(self, observed: Tensor, actions: Tensor, action_weight: Tensor) -> Tensor:
        hidden = F.relu(observed + F.linear(actions, action_weight))  # (B, N, H)
        hidden = F.relu(self.second(hidden))
        # Energies differ by less than bfloat16 resolves, so the last layer is never autocast.
        with torch.autocast(hidden.device.type, enabled=False):
            return self.last(hidden.float()).squeeze(-1)  # (B, N)
