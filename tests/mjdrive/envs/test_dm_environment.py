from collections.abc import Iterator

import dm_env
import numpy as np
import pytest
from absl.testing import absltest
from dm_control.rl import control
from dm_control.viewer.runtime import Runtime, State
from dm_env import test_utils

from mjdrive.envs import dm_environment
from mjdrive.errors import ConfigError, UnknownNameError


class EnvironmentTest(test_utils.EnvironmentTestMixin, absltest.TestCase):  # type: ignore[misc]
    """What DeepMind asks of every environment."""

    def make_object_under_test(self) -> control.Environment:
        return dm_environment.load("town02", time_limit=1.0)

    def make_action_sequence(self) -> Iterator[np.ndarray]:
        for _ in range(24):  # beyond the end of the episode
            yield np.array([0.5, 0.1])


@pytest.fixture(scope="module")
def env() -> control.Environment:
    return dm_environment.load("town02", seed=4, time_limit=20.0)


def drive(
    env: control.Environment, action: tuple[float, float], most: int = 300
) -> dm_env.TimeStep:
    step = env.reset()
    for _ in range(most):
        step = env.step(np.array(action))
        if step.last():
            break
    return step


def test_time_limit_keeps_the_discount_and_an_infraction_ends_it(env: control.Environment) -> None:
    timed = drive(env, (-1.0, 0.0))
    assert timed.last()
    assert timed.discount == 1.0
    crashed = drive(env, (0.6, 1.0))
    assert crashed.last()
    assert crashed.discount == 0.0
    assert crashed.reward < -5.0


def test_seed_decides_all_episodes() -> None:
    views = []
    for seed in (1, 1, 2):
        env = dm_environment.load("town02", seed=seed)
        views.append([env.reset().observation["bev"].tobytes() for _ in range(3)])
    assert views[0] == views[1] != views[2]
    assert len(set(views[0])) == 3


def test_physics_is_the_simulation_itself(env: control.Environment) -> None:
    env.reset()
    env.step(np.array([0.5, 0.0]))
    physics = env.physics
    assert physics.time() == pytest.approx(0.1)
    assert physics.data.time == pytest.approx(0.1)
    assert physics.position()[0] == physics.world.simulation.vehicle.x
    assert physics.named.model.body_mass["car"] > 1000.0
    assert env.control_timestep() == pytest.approx(0.1)
    with pytest.raises(NotImplementedError, match="another environment"):
        physics.copy()


def test_the_runtime_of_dm_controls_viewer_runs_and_restarts_it() -> None:
    env = dm_environment.load("town02", seed=4, time_limit=1.0)
    runtime = Runtime(env, policy=lambda step: np.array([1.0, 0.0]))
    begun: list[float] = []
    changed: list[bool] = []
    runtime.on_episode_begin += lambda: begun.append(runtime.get_time())
    runtime.on_physics_changed += lambda: changed.append(True)
    runtime.tick(0.1, paused=True)
    assert (runtime.state, runtime.get_time()) == (State.RUNNING, 0.0)
    for _ in range(5):
        runtime.tick(0.1, paused=False)
    assert 0.3 < runtime.get_time() < 0.7
    runtime.single_step()
    runtime.restart()
    runtime.tick(0.1, paused=False)
    assert runtime.get_time() == pytest.approx(0.1)
    for _ in range(15):
        runtime.tick(0.1, paused=False)
    assert runtime.state == State.STOPPED  # by the time limit
    runtime.restart()
    runtime.tick(0.1, paused=False)
    assert runtime.state == State.RUNNING
    assert begun == [0.0, 0.0, 0.0]
    assert changed == []  # no model is built again, so the viewer keeps its own


def test_mistakes_are_told() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'town02'"):
        dm_environment.load("town2")
    with pytest.raises(ConfigError, match=r"time_limit is 0\.0 s"):
        dm_environment.load("town02", time_limit=0.0)
