"""The simulation as a dm_env environment, for the tools of dm_control and Acme."""

import numpy as np
from dm_control.rl import control

from mjdrive.config import EnvConfig, require
from mjdrive.envs.dm_physics import CarPhysics
from mjdrive.envs.dm_task import DriveTask
from mjdrive.envs.world import World
from mjdrive.vehicle import cars


def load(
    town: str = "town02",
    *,
    seed: int = 0,
    time_limit: float = 120.0,
    car: str = cars.DEFAULT,
    config: EnvConfig | None = None,
) -> control.Environment:
    """Make a `dm_control.rl.control.Environment`.

    An episode that its time limit ends has the discount 1, one that an infraction ends the discount 0.

    Args:
        town: Name of the town.
        seed: Decides places and lights of all episodes; the same seed gives the same bytes.
        time_limit: Longest episode [s].
        car: Name or MJCF file of the car.
        config: Rewards and endings.

    Raises:
        ConfigError: If the time limit is not positive.
        UnknownNameError: If there is no such town.
        CarError: If there is no such car.
    """
    require(time_limit > 0, f"time_limit is {time_limit} s; expected more than 0.")
    physics = CarPhysics(World(town, car=car, config=config))
    return control.Environment(
        physics,
        DriveTask(np.random.default_rng(seed)),
        time_limit=time_limit,
        n_sub_steps=physics.num_substeps,
    )
