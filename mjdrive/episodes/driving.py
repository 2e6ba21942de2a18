"""Free driving: no route for learned policies, a random walk through the town for experts."""

import dataclasses
from collections.abc import Callable, Mapping

import numpy as np

from mjdrive.config import CollectConfig, PidConfig
from mjdrive.datatypes import Episode, Observation, Policy
from mjdrive.episodes.collection import expert_of
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowWalk, observe
from mjdrive.expert.reference import require_green
from mjdrive.expert.solves import SolveWatch
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import routing
from mjdrive.town.random_lanes import Choose
from mjdrive.town.random_walk import RandomWalk


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
    config: CollectConfig | None = None,
    on_step: Callable[[int], None] | None = None,
    on_late_plans: Callable[[int], None] | None = None,
    choose: Choose | None = None,
    walk: int = 0,
    metadata: Mapping[str, str] | None = None,
) -> Episode:
    """Let an expert take random turns, from the place where `drive` starts with the same seed and steps.

    Fewer steps give the beginning of the same drive wherever some lanes lead on for ever.

    Args:
        simulation: World to drive in; it is reset.
        num_steps: Control steps [-].
        seed: Decides start, lights and turns.
        config: Which expert drives, and its settings; the PID expert if None.
        on_step: Told the number of control steps done.
        on_late_plans: Told at the end how many plans of the expert came late on this machine.
        choose: Chooses among the ways on instead of chance.
        walk: Another number, other turns from the same start and under the same lights [-].
        metadata: Versions, digests and settings to keep with the episode.

    Returns:
        The drive.

    Raises:
        RouteError: If the lanes do not lead on for long enough, or a light that never turns green stands in the way.
        SolverError: If the solver of the MPC expert is missing.
    """
    config = config or CollectConfig()
    town = simulation.town
    expert = expert_of(config, simulation)
    require_green(town.lights.values())
    lane, station = _start(simulation, config.pid, num_steps=num_steps, seed=seed)
    random_walk = RandomWalk(
        town,
        lane=lane,
        station=station,
        # Turns have a stream of their own, so that they do not hang on how a start is drawn.
        rng=np.random.default_rng([seed, 1 + walk]),
        length=_way(simulation, config.pid, num_steps),
        choose=choose,
    )
    simulation.reset(lane=lane, station=station, seed=seed)
    solves = SolveWatch(expert)
    episode = rollout(
        simulation,
        expert,
        FollowWalk(random_walk),
        num_steps=num_steps,
        seed=seed,
        on_step=on_step,
        metadata=metadata,
    )
    if on_late_plans is not None:
        on_late_plans(solves.late)
    return dataclasses.replace(episode, metadata={**episode.metadata, **solves.metadata()})


def _start(
    simulation: Simulation, config: PidConfig, *, num_steps: int, seed: int
) -> tuple[str, float]:
    """Draw a place from which the lanes lead on for as long as the drive, where the town has any."""
    length = _way(simulation, config, num_steps)
    return routing.random_start(simulation.town, np.random.default_rng(seed), length=length)


def _way(simulation: Simulation, config: PidConfig, num_steps: int) -> float:
    """Length of a route that the expert does not come to the end of [m]."""
    return config.target_speed * num_steps * simulation.config.control_interval + 50.0
