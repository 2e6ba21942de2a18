"""Policy + simulation -> episode."""

from collections.abc import Callable, Mapping
from typing import TypeVar

import numpy as np

from mjdrive.datatypes import Action, Episode, Infraction, Policy
from mjdrive.episodes.disturbance import Disturbance
from mjdrive.simulation.simulation import Simulation

View = TypeVar("View")


def rollout(
    simulation: Simulation,
    policy: Policy[View],
    view: Callable[[Simulation], View],
    *,
    num_steps: int,
    seed: int,
    disturbance: Disturbance | None = None,
    stop: Callable[[], bool] | None = None,
    on_step: Callable[[int], None] | None = None,
    metadata: Mapping[str, str] | None = None,
) -> Episode:
    """Let a policy drive a simulation that has just been reset.

    Args:
        simulation: World to drive in.
        policy: Who drives.
        view: What the policy gets to see of the simulation.
        num_steps: Control steps at most [-].
        seed: Seed of the policy, written into the episode.
        disturbance: Changes the action that is driven; the label stays the policy's own.
        stop: Ends the episode early when it says so, asked after each step.
        on_step: Told the number of steps done.
        metadata: Versions, digests and settings to keep with the episode.

    Returns:
        The drive, one row a control step.
    """
    policy.reset(seed)
    rows: list[tuple[float, np.ndarray, tuple[float, ...], Action, Action, bool]] = []
    infractions: list[Infraction] = []
    for step in range(num_steps):
        label = policy.act(view(simulation))
        action = label if disturbance is None else disturbance.apply(label)
        vehicle = simulation.vehicle
        before = (
            simulation.time,
            simulation.car.save(),
            (
                vehicle.x,
                vehicle.y,
                vehicle.yaw,
                vehicle.speed,
                vehicle.yaw_rate,
                vehicle.steering_angle,
            ),
        )
        is_on_lane = simulation.is_on_lane
        infractions += simulation.step(action)
        rows.append((*before, simulation.action, label, is_on_lane))
        if on_step is not None:
            on_step(step + 1)
        if stop is not None and stop():
            break
    times, physics, vehicles, actions, labels, on_lane = zip(*rows, strict=True)
    return Episode(
        town=simulation.town.name,
        policy=policy.name,
        seed=seed,
        light_phase=simulation.light_phase,
        time=np.array(times),
        physics=np.array(physics),
        vehicle=np.array(vehicles),
        actions=_as_array(actions),
        labels=_as_array(labels),
        on_lane=np.array(on_lane),
        infractions=tuple(infractions),
        metadata=dict(metadata or {}),
    )


def _as_array(actions: tuple[Action, ...]) -> np.ndarray:
    return np.array([(action.acceleration, action.steering) for action in actions])
