"""Other people's learners train on the environment: Stable-Baselines3, for two thousand steps."""

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO

import mjdrive  # noqa: F401  (registers the environments)


def test_ppo_trains() -> None:
    torch.set_num_threads(1)
    env = gymnasium.make("mjdrive/Town02-v0", max_episode_steps=128)
    learner = PPO(
        "MultiInputPolicy",
        env,
        n_steps=512,
        batch_size=128,
        n_epochs=1,
        policy_kwargs={"features_extractor_kwargs": {"cnn_output_dim": 32}},  # a small network
        seed=0,
        device="cpu",
    )
    before = {name: value.clone() for name, value in learner.policy.state_dict().items()}
    learner.learn(2048)
    assert learner.num_timesteps == 2048
    assert all(torch.isfinite(value).all() for value in learner.policy.state_dict().values())
    changed = [
        not torch.equal(before[name], now) for name, now in learner.policy.state_dict().items()
    ]
    assert all(changed)
    assert np.isfinite([episode["r"] for episode in learner.ep_info_buffer or ()]).all()
    assert len(learner.ep_info_buffer or ()) >= 2048 // 128
