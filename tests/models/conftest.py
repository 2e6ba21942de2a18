"""Small demonstrations and settings for the tests of the networks."""

import dataclasses
import math
from collections.abc import Callable

import pytest
import torch

from models.config import DensityConfig, LearnerConfig, Method, NegativesConfig
from models.interfaces import Batch, Learner, TensorDemonstrations
from models.learners import build_learner
from models.presets import quick


def _small_config(method: Method, **optimiser: object) -> LearnerConfig:
    """Settings that train in a fraction of a second; presets may change, these stay."""
    config = quick(method)
    settings = {"epochs": 2, "batch_size": 4, "precision": "float32", **optimiser}
    return dataclasses.replace(
        config,
        negatives=NegativesConfig(count=8),
        density=DensityConfig(weighting="sampler"),
        optimiser=dataclasses.replace(config.optimiser, **settings),
    )


@pytest.fixture(scope="session", autouse=True)
def _one_thread() -> None:
    """Tests run beside each other; networks that fight over cores wait for each other."""
    torch.set_num_threads(1)


@pytest.fixture(scope="session")
def batch() -> Batch:
    """Ten observations of noise, with actions that include the corners."""
    generator = torch.Generator().manual_seed(0)
    bev = torch.randint(0, 256, (10, 5, 192, 192), generator=generator, dtype=torch.uint8)
    state = torch.rand(10, 3, generator=generator)
    actions = 2 * torch.rand(10, 2, generator=generator) - 1
    actions[:3] = torch.tensor([[-1.0, 0.0], [1.0, -1.0], [0.0, 1.0]])
    return Batch(bev, state, actions)


@pytest.fixture(scope="session")
def demonstrations(batch: Batch) -> TensorDemonstrations:
    return TensorDemonstrations(batch)


@pytest.fixture(scope="session")
def small_config() -> Callable[..., LearnerConfig]:
    return _small_config


@pytest.fixture
def generator() -> torch.Generator:
    return torch.Generator().manual_seed(7)


class Fork:
    """A known density: two round Gaussians, at left and right, of unequal mass."""

    share_left = 0.65
    centres = torch.tensor([[0.2, 0.4], [0.2, -0.4]])
    deviation = 0.08

    def draw(self, num: int, generator: torch.Generator) -> torch.Tensor:
        """Actions (num, 2) [-]."""
        is_right = torch.rand(num, generator=generator) >= self.share_left
        noise = torch.randn(num, 2, generator=generator)
        return self.centres[is_right.long()] + self.deviation * noise

    def batch(self, num: int, generator: torch.Generator) -> Batch:
        """What the expert does, seen by nobody."""
        return Batch(*self.unseen(num), self.draw(num, generator))

    @staticmethod
    def unseen(num: int) -> tuple[torch.Tensor, torch.Tensor]:
        """Observations that nothing looks at."""
        return torch.zeros(num, 1, 1, 1, dtype=torch.uint8), torch.zeros(num, 3)

    def log_density(self, actions: torch.Tensor, *, noise: float = 0.0) -> torch.Tensor:
        """Log density of actions (..., 2) that noise was added to [nats]."""
        return torch.logsumexp(self._log_parts(actions, 1.0, noise), dim=-1)

    def clean(self, noisy: torch.Tensor, signal: float, level: float) -> torch.Tensor:
        """Mean of the action y (..., 2) given noisy = signal * y + level * noise [-]."""
        variance = (signal * self.deviation) ** 2 + level**2
        kept = signal * self.deviation**2 / variance
        offsets = noisy[..., None, :] - signal * self.centres.to(noisy)
        means = self.centres.to(noisy) + kept * offsets  # (..., 2 modes, 2)
        shares = torch.softmax(self._log_parts(noisy, signal, level), dim=-1)
        return (shares[..., None] * means).sum(dim=-2)

    def _log_parts(self, noisy: torch.Tensor, signal: float, level: float) -> torch.Tensor:
        variance = (signal * self.deviation) ** 2 + level**2
        squares = (noisy[..., None, :] - signal * self.centres.to(noisy)).square().sum(dim=-1)
        shares = torch.tensor([self.share_left, 1 - self.share_left]).to(noisy)
        return shares.log() - squares / (2 * variance) - math.log(2 * math.pi * variance)


class Constant(torch.nn.Module):
    """Stands in for the encoder: every observation looks alike."""

    feature_size = 256

    def forward(self, bev: torch.Tensor, state: torch.Tensor) -> torch.Tensor:
        return torch.full((len(bev), self.feature_size), 0.05)


@pytest.fixture(scope="session")
def fork() -> Fork:
    return Fork()


@pytest.fixture(scope="session")
def train_at_fork() -> Callable[..., Learner]:
    """Trains a learner on fresh actions of a fork; the encoder is left out."""

    def train(config: LearnerConfig, density: Fork, *, steps: int, rate: float) -> Learner:
        learner = build_learner(config, seed=0)
        learner.encoder = Constant()
        generator = torch.Generator().manual_seed(0)
        optimiser = torch.optim.Adam(learner.parameters(), lr=rate, fused=True)
        for step in range(steps):
            optimiser.param_groups[0]["lr"] = rate * (1 - step / steps)
            batch = density.batch(64, generator)
            chance = learner.draw(batch.actions, generator=generator)
            optimiser.zero_grad()
            learner.loss(batch, chance, weights=None).backward()
            optimiser.step()
        return learner.eval()

    return train
