"""Gymnasium's CarRacing, for mjdrive/benchmarks/serving.py."""

import importlib.metadata

import gymnasium
import numpy as np

PACKAGE = "gymnasium"
SEED = 0
ACTION = np.array([0.0, 0.1, 0.0], np.float32)
"""Straight on with a little throttle."""


class CarRacingWorld:
    """CarRacing as it comes: 96 x 96 x 3, 50 steps a second of simulated time."""

    def __init__(self) -> None:
        self._env = gymnasium.make("CarRacing-v3")
        self.num_resets = 0
        self.deciding = 0.0
        view, _ = self._env.reset(seed=SEED)
        self.facts = {
            "versions": {PACKAGE: importlib.metadata.version(PACKAGE)},
            "observation": list(view.shape),
        }

    def step(self) -> None:
        """Do one step; start again at the end of an episode."""
        _, _, terminated, truncated, _ = self._env.step(ACTION)
        if terminated or truncated:
            self._env.reset(seed=SEED)
            self.num_resets += 1


def make(argument: str) -> CarRacingWorld:
    """Make the world; it takes no argument."""
    return CarRacingWorld()
