"""What the Gymnasium environment would have paid for a drive that was recorded."""

from itertools import pairwise

import numpy as np
from jaxtyping import Float

from mjdrive.config import RewardConfig
from mjdrive.datatypes import Episode, Town, VehicleState
from mjdrive.envs import rewards
from mjdrive.envs.lane_sense import LaneSense
from mjdrive.vehicle.parameters import VehicleParameters


def rewards_of(
    episode: Episode,
    town: Town,
    parameters: VehicleParameters,
    config: RewardConfig | None = None,
) -> Float[np.ndarray, " N"]:
    """Reward of every step but the last, whose end was not recorded.

    Args:
        episode: The drive.
        town: Where it was driven.
        parameters: Of the car.
        config: Weights of the terms; the environment's own if None.

    Returns:
        One reward for each of the first T - 1 actions [-].
    """
    config, lanes = config or RewardConfig(), LaneSense(town, parameters)
    vehicles = [VehicleState(*row) for row in episode.vehicle.tolist()]
    paid = np.zeros(len(vehicles) - 1)
    for step, (before, after) in enumerate(pairwise(vehicles)):
        start, end = (float(now) for now in episode.time[step : step + 2])
        breaches = [it for it in episode.infractions if start + 1e-9 < it.time <= end + 1e-9]
        paid[step] = sum(
            rewards.terms(
                config,
                before=before,
                after=after,
                in_lane=lanes.follows(after),
                infractions=breaches,
                interval=end - start,
            ).values()
        )
    return paid
