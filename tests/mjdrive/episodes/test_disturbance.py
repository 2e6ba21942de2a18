import numpy as np
import pytest

from mjdrive.config import DisturbanceConfig
from mjdrive.datatypes import Action
from mjdrive.episodes.disturbance import Disturbance
from mjdrive.errors import ConfigError

CRUISE = Action(acceleration=0.1, steering=0.0)


def drive(config: DisturbanceConfig, *, seed: int = 0, num_steps: int = 6000) -> np.ndarray:
    disturbance = Disturbance(config, np.random.default_rng(seed))
    driven = [disturbance.apply(CRUISE) for _ in range(num_steps)]
    return np.array([(action.acceleration, action.steering) for action in driven])


def test_same_seed_disturbs_alike_and_another_does_not():
    config = DisturbanceConfig()
    np.testing.assert_array_equal(drive(config), drive(config))
    assert not np.array_equal(drive(config), drive(config, seed=1))


def test_steering_stays_within_the_amplitude_and_pushes_both_ways():
    steering = drive(DisturbanceConfig(steering_amplitude=0.3))[:, 1]
    assert 0.2 < steering.max() <= 0.3
    assert -0.3 <= steering.min() < -0.2


def test_pulses_start_at_the_asked_rate_of_quiet_time():
    config = DisturbanceConfig(steering_rate_per_min=20.0, stop_rate_per_min=0.0)
    steering = drive(config, num_steps=60_000)[:, 1]
    starts = np.count_nonzero((steering[1:] != 0) & (steering[:-1] == 0))
    quiet_min = np.count_nonzero(steering == 0) * 0.1 / 60
    assert starts / quiet_min == pytest.approx(20.0, rel=0.15)


def test_stops_brake_for_their_duration():
    config = DisturbanceConfig(steering_rate_per_min=0.0, stop_rate_per_min=2.0, stop_duration=1.0)
    braking = drive(config)[:, 0] < 0
    edges = np.flatnonzero(np.diff(braking.astype(int)))
    lengths = edges[1::2] - edges[:-1:2]
    assert len(lengths) > 5
    assert lengths.min() >= 10


def test_an_expert_that_brakes_harder_is_left_alone():
    disturbance = Disturbance(DisturbanceConfig(stop_rate_per_min=600.0), np.random.default_rng(0))
    assert disturbance.apply(Action(-1.0, 0.0)).acceleration == -1.0


def test_impossible_amplitude_is_refused():
    with pytest.raises(ConfigError, match="steering_amplitude is 2"):
        DisturbanceConfig(steering_amplitude=2.0)


def test_throttle_pulses_push_both_ways_at_their_rate():
    config = DisturbanceConfig(
        steering_rate_per_min=0.0,
        stop_rate_per_min=0.0,
        throttle_rate_per_min=15.0,
        throttle_amplitude=0.5,
    )
    driven = drive(config, num_steps=60_000)
    assert not driven[:, 1].any()
    pushed = driven[:, 0] - CRUISE.acceleration
    assert 0.3 < pushed.max() <= 0.5 + 1e-9
    assert -0.5 - 1e-9 <= pushed.min() < -0.3
    starts = np.count_nonzero((pushed[1:] != 0) & (pushed[:-1] == 0))
    quiet_min = np.count_nonzero(pushed == 0) * 0.1 / 60
    assert starts / quiet_min == pytest.approx(15.0, rel=0.15)


def test_throttle_pulses_leave_the_other_disturbances_as_they_are():
    without = drive(DisturbanceConfig())
    pushed = drive(DisturbanceConfig(throttle_rate_per_min=15.0))
    np.testing.assert_array_equal(pushed[:, 1], without[:, 1])
    assert not np.array_equal(pushed[:, 0], without[:, 0])
