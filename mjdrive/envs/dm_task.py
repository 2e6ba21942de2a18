"""Driving freely as a task of dm_control."""

from collections import OrderedDict

import numpy as np
from dm_control.rl import control
from dm_env import specs
from jaxtyping import Float

from mjdrive.bev.layers import Layer
from mjdrive.config import BevConfig
from mjdrive.envs.dm_physics import CarPhysics

Seen = OrderedDict[str, np.ndarray]
"""Observation: "bev" and "state"."""


class DriveTask(control.Task):  # type: ignore[misc]  # dm_control has no types
    """Drive as far as the rules let: actions, observations and rewards are those of `DrivingEnv`.

    Args:
        rng: Decides places and lights.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng

    def initialize_episode(self, physics: CarPhysics) -> None:
        """Put the car at rest on a random lane."""
        physics.world.start(self._rng)

    def before_step(self, action: Float[np.ndarray, "2"], physics: CarPhysics) -> None:
        """Hand over acceleration and steering [-]."""
        physics.set_control(action)

    def action_spec(self, physics: CarPhysics) -> specs.BoundedArray:
        """Acceleration and steering in [-1, 1] [-]."""
        return specs.BoundedArray((2,), np.float64, -1.0, 1.0, name="acceleration\tsteering")

    def observation_spec(self, physics: CarPhysics) -> OrderedDict[str, specs.Array]:
        """Bird's-eye view, and speed [m/s] with the previous action [-]."""
        size = BevConfig().size_px
        return OrderedDict(
            bev=specs.BoundedArray((len(Layer), size, size), np.uint8, 0, 255, name="bev"),
            state=specs.Array((3,), np.float32, name="state"),
        )

    def get_observation(self, physics: CarPhysics) -> Seen:
        """All that a learned policy may see."""
        seen = physics.world.simulation.observe()
        return OrderedDict(bev=seen.bev.copy(), state=seen.state.copy())

    def get_reward(self, physics: CarPhysics) -> float:
        """Sum of the terms of the reward [-]."""
        return 0.0 if physics.outcome is None else physics.outcome.reward

    def get_termination(self, physics: CarPhysics) -> float | None:
        """Discount of the end, 0, if an infraction ended the episode; None while it goes on [-]."""
        return 0.0 if physics.outcome is not None and physics.outcome.is_over else None
