"""Pushes that make an expert show how it recovers, while the clean action stays the label.

Reference:
    Codevilla et al., End-to-end Driving via Conditional Imitation Learning, ICRA 2018 (triangular steering
    perturbations); Laskey et al., DART, CoRL 2017 (noise injection during demonstration).
"""

import numpy as np

from mjdrive.config import DisturbanceConfig
from mjdrive.datatypes import Action


class _Pulse:
    """A triangle in time that starts at random moments."""

    def __init__(self, *, rate_per_min: float, duration: float, interval: float) -> None:
        self._probability = rate_per_min / 60.0 * interval
        self._num_steps = max(round(duration / interval), 1)
        self._step = self._num_steps
        self._peak = 0.0

    def next(self, rng: np.random.Generator, *, smallest: float, largest: float) -> float:
        """Value in the next control step, 0 between pulses."""
        starts, side, size = rng.random(3)
        if self._step >= self._num_steps:
            if starts >= self._probability:
                return 0.0
            self._step = 0
            self._peak = (smallest + size * (largest - smallest)) * (1.0 if side < 0.5 else -1.0)
        self._step += 1
        rise = 1.0 - abs(2.0 * self._step / (self._num_steps + 1) - 1.0)
        return self._peak * rise


class Disturbance:
    """Adds pulses on steering and throttle, and short stops, to what an expert does.

    Args:
        config: How often and how strongly.
        rng: Source of randomness.
        interval: Time between two decisions [s].
    """

    def __init__(
        self, config: DisturbanceConfig, rng: np.random.Generator, *, interval: float = 0.1
    ) -> None:
        self._config = config
        self._rng = rng
        self._steering = _Pulse(
            rate_per_min=config.steering_rate_per_min,
            duration=config.steering_duration,
            interval=interval,
        )
        # Pulses on the throttle have numbers of their own, so that they leave the others as they are.
        self._throttle_rng = rng.spawn(1)[0]
        self._throttle = _Pulse(
            rate_per_min=config.throttle_rate_per_min,
            duration=config.throttle_duration,
            interval=interval,
        )
        self._stop_probability = config.stop_rate_per_min / 60.0 * interval
        self._stop_num_steps = round(config.stop_duration / interval)
        self._stop_left = 0

    def apply(self, action: Action) -> Action:
        """Disturb one action.

        Args:
            action: What the expert wants.

        Returns:
            What is driven instead.
        """
        largest = self._config.steering_amplitude
        pulse = self._steering.next(self._rng, smallest=largest / 3, largest=largest)
        steering = float(np.clip(action.steering + pulse, -1.0, 1.0))
        if self._rng.random() < self._stop_probability and self._stop_left == 0:
            self._stop_left = self._stop_num_steps
        largest = self._config.throttle_amplitude
        pulse = self._throttle.next(self._throttle_rng, smallest=largest / 3, largest=largest)
        acceleration = float(np.clip(action.acceleration + pulse, -1.0, 1.0))
        if self._stop_left > 0:
            self._stop_left -= 1
            acceleration = min(acceleration, -self._config.stop_brake)
        return Action(acceleration=acceleration, steering=steering)
