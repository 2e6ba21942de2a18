"""What every policy keeps, whatever its method."""

import numpy as np
import pytest
import torch

from mjdrive.datatypes import Observation, Policy
from mjdrive.episodes.driving import drive
from mjdrive.learning.pilot import Pilot
from mjdrive.simulation.simulation import Simulation
from models import presets
from models.config import METHODS
from models.learners import build_learner


@pytest.fixture(scope="module", params=METHODS)
def policy(request: pytest.FixtureRequest) -> Pilot:
    learner = build_learner(presets.quick(request.param), seed=0)
    learner.prepare(torch.zeros(8, 2), torch.ones(8))
    return Pilot(learner, name=request.param)


def test_it_is_a_policy(policy: Pilot) -> None:
    assert isinstance(policy, Policy)


def test_same_seed_gives_the_same_episode(policy: Pilot, simulation: Simulation) -> None:
    first, again = (drive(simulation, policy, num_steps=12, seed=4) for _ in range(2))
    np.testing.assert_array_equal(first.physics, again.physics)
    np.testing.assert_array_equal(first.actions, again.actions)
    assert np.all(np.isfinite(first.physics))
    assert np.all(np.abs(first.actions) <= 1)


def test_it_does_not_write_to_what_it_sees(policy: Pilot) -> None:
    seen = Observation(np.full((5, 192, 192), 255, np.uint8), np.ones(3, np.float32))
    policy.reset(0)
    policy.act(seen)
    assert np.all(seen.bev == 255)
    assert np.all(seen.state == 1)
