"""The simulation as the physics of dm_control."""

from typing import Any

import numpy as np
from dm_control.mujoco import engine, wrapper
from jaxtyping import Float

from mjdrive.datatypes import Action
from mjdrive.envs.world import Outcome, World


class CarPhysics(engine.Physics):  # type: ignore[misc]  # dm_control has no types
    """A town with a car, whose steps are those of `Simulation`.

    Model and data are the simulation's own, so dm_control's names, cameras and viewer show the world that is driven.

    Args:
        world: The world to drive.

    Attributes:
        world: The same.
        outcome: What the last control step brought, None before the first one.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.outcome: Outcome | None = None
        self._action = world.simulation.action
        super().__init__(wrapper.MjData(world.simulation.data))

    @property
    def num_substeps(self) -> int:
        """Physics steps in a control step [-]."""
        config = self.world.simulation.config
        return round(config.control_interval / config.timestep)

    def set_control(self, control: Float[np.ndarray, "2"]) -> None:
        """Choose what to do in the next control step.

        Args:
            control: Acceleration and steering; values beyond [-1, 1] are clipped [-].
        """
        acceleration, steering = np.asarray(control, float).tolist()
        self._action = Action(acceleration, steering)

    def step(self, nstep: int = 1) -> None:
        """Drive for one control step.

        Args:
            nstep: As many physics steps as it has [-].
        """
        assert nstep == self.num_substeps, (
            f"{nstep} physics steps asked for; a control step has {self.num_substeps}"
        )
        self.outcome = self.world.step(self._action)

    def reset(self, keyframe_id: int | None = None) -> None:
        """Leave all to the task, which puts the car somewhere; the scene has no key frames."""
        assert keyframe_id is None, f"key frame {keyframe_id} asked for; the scene has none"
        self.outcome = None
        self._action = Action(0.0, 0.0)

    def after_reset(self) -> None:
        """Nothing is left to do: placing the car makes everything up to date."""

    def time(self) -> float:
        """Simulation time since reset [s]."""
        return self.world.simulation.time

    def copy(self, share_model: bool = False) -> Any:
        """Refuse: the car writes to its model, so a copy would be driven by two.

        Raises:
            NotImplementedError: Always.
        """
        raise NotImplementedError(
            "Make another environment instead; its car needs a model of its own."
        )
