"""Other people's learners train on the environment: Stable-Baselines3, for two thousand steps."""

from typing import Any

import gymnasium
import numpy as np
import torch
from gymnasium import spaces
from stable_baselines3 import PPO

import mjdrive  # noqa: F401  (registers the environments)

STEPS = 2048


class Thinned(gymnasium.ObservationWrapper[dict[str, Any], np.ndarray, dict[str, Any]]):
    """Every fourth pixel: most of the time of a whole view goes into the network, which is not what is tested."""

    def __init__(self, env: gymnasium.Env[dict[str, Any], np.ndarray]) -> None:
        super().__init__(env)
        assert isinstance(env.observation_space, spaces.Dict)
        view = spaces.Box(0, 255, (5, 48, 48), np.uint8)
        self.observation_space = spaces.Dict({**env.observation_space.spaces, "bev": view})

    def observation(self, observation: dict[str, Any]) -> dict[str, Any]:
        return {**observation, "bev": observation["bev"][:, ::4, ::4]}


def test_ppo_trains() -> None:
    torch.set_num_threads(1)
    env = Thinned(gymnasium.make("mjdrive/Town02-v0", max_episode_steps=128))
    learner = PPO(
        "MultiInputPolicy", env, n_steps=1024, batch_size=128, n_epochs=2, seed=0, device="cpu"
    )
    before = {name: value.clone() for name, value in learner.policy.state_dict().items()}
    learner.learn(STEPS)
    after = learner.policy.state_dict()
    assert learner.num_timesteps == STEPS
    assert all(torch.isfinite(value).all() for value in after.values())
    assert not any(torch.equal(before[name], value) for name, value in after.items())
    episodes = list(learner.ep_info_buffer or ())
    assert len(episodes) >= STEPS // 128
    assert np.isfinite([episode["r"] for episode in episodes]).all()
