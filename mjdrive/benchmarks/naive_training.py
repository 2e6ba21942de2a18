"""The training loop that one writes first: uint8 images in a DataLoader, float32 throughout, autograd for everything.

Networks, losses and Adam are those of the paper, as `models` has them. The energy is fused late, as google-research/ibc
and diffusion_policy do it: images are encoded once, then the feature is tiled beside every candidate.
"""

from collections.abc import Callable

import torch
from torch import Tensor, nn
from torch.distributions import Beta
from torch.nn import functional as F  # noqa: N812
from torch.utils.data import DataLoader, TensorDataset

from models.interfaces import Demonstrations

HIDDEN = 256
LOADED_AT_A_TIME = 128


class Encoder(nn.Module):
    """The network of the paper over image and state."""

    def __init__(self) -> None:
        super().__init__()
        layers: list[nn.Module] = []
        sizes = ((8, 5, 2), (16, 5, 2), (32, 5, 2), (64, 3, 2), (128, 3, 2), (256, 3, 1))
        channels = 5
        for channels_out, kernel, stride in sizes:
            layers += [nn.Conv2d(channels, channels_out, kernel, stride), nn.ReLU()]
            channels = channels_out
        self.image = nn.Sequential(*layers, nn.Flatten())
        self.state = nn.Sequential(
            nn.Linear(3, HIDDEN), nn.ReLU(), nn.Linear(HIDDEN, HIDDEN), nn.ReLU()
        )
        self.joint = nn.Sequential(
            nn.Linear(1024 + HIDDEN, 512), nn.ReLU(), nn.Linear(512, HIDDEN), nn.ReLU()
        )

    def forward(self, image: Tensor, state: Tensor) -> Tensor:
        """Features (B, 256) of images (B, 5, 192, 192) and states (B, 3)."""
        return self.joint(torch.cat((self.image(image.float() / 255), self.state(state)), dim=1))


def head(num_inputs: int, num_outputs: int) -> nn.Sequential:
    """Two hidden layers and an output."""
    return nn.Sequential(
        nn.Linear(num_inputs, HIDDEN),
        nn.ReLU(),
        nn.Linear(HIDDEN, HIDDEN),
        nn.ReLU(),
        nn.Linear(HIDDEN, num_outputs),
    )


class NaiveLoop:
    """Trains an epoch when it is called.

    Args:
        demonstrations: What to learn from; their images are kept as they come, a byte a channel.
        batch_size: Pairs a step [-].
        num_negatives: Disturbed expert actions beside each (DA-IBC); 0 trains BC-Beta instead.
    """

    def __init__(
        self, demonstrations: Demonstrations, *, batch_size: int, num_negatives: int
    ) -> None:
        parts = torch.arange(len(demonstrations)).split(LOADED_AT_A_TIME)
        tensors = zip(*(demonstrations.batch(part) for part in parts), strict=True)
        data = TensorDataset(*(torch.cat(tensor).contiguous() for tensor in tensors))
        self._loader = DataLoader(data, batch_size=batch_size, shuffle=True)
        self._num_negatives = num_negatives
        self._encoder = Encoder()
        self._head = head(HIDDEN + 2, 1) if num_negatives else head(HIDDEN, 4)
        self._optimiser = torch.optim.Adam(
            [*self._encoder.parameters(), *self._head.parameters()], lr=1e-5
        )

    def __call__(self) -> list[float]:
        """Train on every pair once; the loss of each step."""
        loss_of: Callable[[Tensor, Tensor], Tensor] = (
            self._info_nce if self._num_negatives else self._likelihood
        )
        losses = []
        for image, state, actions in self._loader:
            loss = loss_of(self._encoder(image, state), actions)
            self._optimiser.zero_grad()
            loss.backward()
            self._optimiser.step()
            losses.append(loss.item())
        return losses

    def _info_nce(self, features: Tensor, actions: Tensor) -> Tensor:
        shape = (len(actions), self._num_negatives)
        negatives = actions[torch.randint(len(actions), shape)] + 0.22 * torch.randn(*shape, 2)
        return self._contrast(features, actions, negatives.clamp(-1, 1))

    def _contrast(self, features: Tensor, actions: Tensor, negatives: Tensor) -> Tensor:
        candidates = torch.cat((actions[:, None], negatives), dim=1)
        tiled = features[:, None].expand(-1, candidates.shape[1], -1)
        energies = self._head(torch.cat((tiled, candidates), dim=2)).squeeze(-1)
        return F.cross_entropy(-energies, torch.zeros(len(actions), dtype=torch.long))

    def _likelihood(self, features: Tensor, actions: Tensor) -> Tensor:
        alpha, beta = F.softplus(self._head(features)).chunk(2, dim=1)
        labels = ((actions + 1) / 2).clamp(1e-3, 1 - 1e-3)
        return -Beta(alpha + 1e-6, beta + 1e-6).log_prob(labels).sum(dim=1).mean()
