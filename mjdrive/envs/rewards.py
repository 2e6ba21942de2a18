"""The reward of one control step, term by term. Pure functions."""

import math
from collections.abc import Iterable

from mjdrive.config import RewardConfig
from mjdrive.datatypes import Infraction, InfractionKind, VehicleState

INFRACTION_TERMS = {kind: kind.name.lower() for kind in InfractionKind}
"""Name of the term, and of the setting, that each infraction counts in."""

TERMS = ("progress", "comfort", *INFRACTION_TERMS.values())
"""All terms, in the order of `terms`."""


def terms(
    config: RewardConfig,
    *,
    before: VehicleState,
    after: VehicleState,
    in_lane: bool,
    infractions: Iterable[Infraction],
    interval: float,
) -> dict[str, float]:
    """Weigh what happened in a step; the reward is the sum of the terms.

    Args:
        config: Weights.
        before: State of the car at the beginning.
        after: State at the end.
        in_lane: Whether the car is on a lane that runs its way at the end.
        infractions: Breaches of the rules.
        interval: Length of the step [s].

    Returns:
        Every term of `TERMS` by name; rewards are positive, costs negative [-].
    """
    weighed = dict.fromkeys(TERMS, 0.0)
    if in_lane:
        rewarded = min(travel(before, after), config.rewarded_speed * interval)
        weighed["progress"] = config.progress * rewarded
    weighed["comfort"] = -config.comfort * squared_acceleration(before, after, interval) * interval
    for infraction in infractions:
        name = INFRACTION_TERMS[infraction.kind]
        weighed[name] -= getattr(config, name)
    return weighed


def travel(before: VehicleState, after: VehicleState) -> float:
    """Way along the heading of the car, negative when it goes back [m]."""
    x, y = after.x - before.x, after.y - before.y
    return x * math.cos(before.yaw) + y * math.sin(before.yaw)


def squared_acceleration(before: VehicleState, after: VehicleState, interval: float) -> float:
    """Squared acceleration along and across the car, of a step of `interval` seconds [m2/s4]."""
    along = (after.speed - before.speed) / interval
    across = after.speed * after.yaw_rate
    return along**2 + across**2
