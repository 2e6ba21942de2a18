"""highway-env's intersection with grey views, for mjdrive/benchmarks/serving.py."""

import importlib.metadata

import gymnasium
import highway_env

PACKAGE = "highway-env"
SEED = 0
IDLE = 1
"""The choice that keeps the speed."""


class IntersectionWorld:
    """The intersection with its traffic, decided and seen ten times a second, one step of its physics each."""

    def __init__(self, size: int) -> None:
        gymnasium.register_envs(highway_env)
        config = {
            "observation": {
                "type": "GrayscaleObservation",
                "observation_shape": (size, size),
                "stack_size": 5,
                "weights": [0.2989, 0.5870, 0.1140],
                "scaling": 5.0,
            },
            "policy_frequency": 10,
            "simulation_frequency": 10,
        }
        self._env = gymnasium.make("intersection-v2", config=config, disable_env_checker=True)
        self.num_resets = 0
        self.deciding = 0.0
        view, _ = self._env.reset(seed=SEED)
        self.facts = {
            "versions": {PACKAGE: importlib.metadata.version(PACKAGE)},
            "observation": list(view.shape),
        }

    def step(self) -> None:
        """Do one step; start again at the end of an episode."""
        _, _, terminated, truncated, _ = self._env.step(IDLE)
        if terminated or truncated:
            self._env.reset(seed=SEED)
            self.num_resets += 1


def make(argument: str) -> IntersectionWorld:
    """Make the world; `argument` is the width of the view [px]."""
    return IntersectionWorld(int(argument))
