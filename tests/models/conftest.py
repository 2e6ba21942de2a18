"""Small demonstrations and settings for the tests of the networks."""

import dataclasses
from collections.abc import Callable

import pytest
import torch

from models.config import DensityConfig, LearnerConfig, Method, NegativesConfig
from models.interfaces import Batch, TensorDemonstrations
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
