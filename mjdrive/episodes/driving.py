"""Free driving: no route for learned policies, a random walk through the town for experts."""

from collections.abc import Callable, Mapping

import numpy as np

from mjdrive.config import PidConfig
from mjdrive.datatypes import Episode, Observation, Policy
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute, observe
from mjdrive.expert.pid import PidExpert
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import routing


def drive(
    simulation: Simulation,
    policy: Policy[Observation],
    *,
    num_steps: int,
    seed: int,
    on_step: Callable[[int], None] | None = None,
    metadata: Mapping[str, str] | None = None,
) -> Episode:
    """Let a learned policy drive where it likes, from a random place.

    Args:
        simulation: World to drive in; it is reset.
        policy: Who drives.
        num_steps: Control steps [-].
        seed: Decides start, lights and the policy's own randomness.
        on_step: Told the number of control steps done.
        metadata: Versions, digests and settings to keep with the episode.

    Returns:
        The drive.
    """
    lane, station = _start(simulation, PidConfig(), num_steps=num_steps, seed=seed)
    simulation.reset(lane=lane, station=station, seed=seed)
    return rollout(
        simulation,
        policy,
        observe,
        num_steps=num_steps,
        seed=seed,
        on_step=on_step,
        metadata=metadata,
    )


def drive_expert(
    simulation: Simulation,
    *,
    num_steps: int,
    seed: int,
    config: PidConfig | None = None,
    on_step: Callable[[int], None] | None = None,
    metadata: Mapping[str, str] | None = None,
) -> Episode:
    """Let the PID expert take random turns, from the place where `drive` starts with the same seed and steps.

    Args:
        simulation: World to drive in; it is reset.
        num_steps: Control steps [-].
        seed: Decides start, lights and turns.
        config: Settings of the expert.
        on_step: Told the number of control steps done.
        metadata: Versions, digests and settings to keep with the episode.

    Returns:
        The drive.
    """
    config = config or PidConfig()
    town, interval = simulation.town, simulation.config.control_interval
    lane, station = _start(simulation, config, num_steps=num_steps, seed=seed)
    # Turns have a stream of their own, so that they do not hang on how a start is drawn.
    turns = np.random.default_rng([seed, 1])
    length = _way(simulation, config, num_steps)
    route = routing.random_route(town, lane=lane, station=station, length=length, rng=turns)
    simulation.reset(lane=lane, station=station, seed=seed)
    return rollout(
        simulation,
        PidExpert(
            town,
            parameters=simulation.car.parameters,
            config=config,
            control_interval=interval,
        ),
        FollowRoute(route),
        num_steps=num_steps,
        seed=seed,
        on_step=on_step,
        metadata=metadata,
    )


def _start(
    simulation: Simulation, config: PidConfig, *, num_steps: int, seed: int
) -> tuple[str, float]:
    """Draw a place from which the lanes lead on for as long as the drive, where the town has any."""
    length = _way(simulation, config, num_steps)
    return routing.random_start(simulation.town, np.random.default_rng(seed), length=length)


def _way(simulation: Simulation, config: PidConfig, num_steps: int) -> float:
    """Length of a route that the expert does not come to the end of [m]."""
    return config.target_speed * num_steps * simulation.config.control_interval + 50.0
