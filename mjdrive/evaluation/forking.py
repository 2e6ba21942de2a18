"""The same moment before a junction, lived many times: which ways does a policy take from there, and how safely?

A drive shows one choice for each moment. Here one state before a junction is restored again and again, and only the
policy's own chance differs, so the spread of the ways taken is that of the policy and of nothing else.

Reference:
    Jia et al., Towards Diverse Behaviors (D3IL), ICLR 2024: conditional behaviour entropy over successful rollouts.
"""

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mjdrive.datatypes import Episode, InfractionKind, Lane, Observation, Policy, Signal
from mjdrive.episodes.plan import episode_seed
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowWalk, observe
from mjdrive.errors import UnknownNameError
from mjdrive.evaluation.branches import branches_taken
from mjdrive.evaluation.choices import Approach, approaches, entropy
from mjdrive.expert.pid import PidExpert
from mjdrive.geometry import headings
from mjdrive.simulation.simulation import Simulation, Snapshot
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.random_walk import RandomWalk

FARTHEST = 12.0
"""Distance of the rear axle from the end of an approach when the moment is kept [m]: light and exits are in sight, nothing is decided."""

RUN_UP = 45.0
"""The expert starts so far before the end, or at the beginning of a shorter lane [m]."""

NUM_ATTEMPTS, NUM_STEPS = 20, 200
"""Light phases to try, and control steps for each [-]."""

SLOWEST = 3.0
"""A car that stands before the light has not yet to choose [m/s]."""

JUDGED_AFTER = 5.0
"""Whether the car is still on the road is looked at until then [s]."""

HORIZON = 12.0
"""Time to drive through the junction [s]."""

_MISHAPS = (InfractionKind.COLLISION, InfractionKind.OFF_ROAD, InfractionKind.WRONG_WAY)


@dataclass(frozen=True, slots=True)
class Fork:
    """A moment before a junction.

    Attributes:
        approach: Name of the lane that the car is on.
        exits: Names of the junction lanes that lead on from it.
        snapshot: The state of the simulation.
    """

    approach: str
    exits: tuple[str, ...]
    snapshot: Snapshot


@dataclass(frozen=True, slots=True)
class ForkOutcome:
    """What a policy made of one moment.

    Attributes:
        approach: Name of the lane that the car was on.
        rollouts: How often the moment was lived [-].
        safe: Share of them with no collision and not off the road or against the traffic within 5 s [-].
        taken: How often each exit was driven to its end in a safe one, by name [-].
        entropy: Entropy of the exits over its largest value, over the safe ones that took one [-]; None if none did.
    """

    approach: str
    rollouts: int
    safe: float
    taken: Mapping[str, int]
    entropy: float | None


def find_forks(
    simulation: Simulation, *, seed: int, names: Sequence[str] | None = None
) -> tuple[Fork, ...]:
    """Let the PID expert drive up to junctions at green and keep one moment before each.

    Args:
        simulation: Where; it is left at the last moment.
        seed: Decides what the lights show on the way.
        names: Approaches to drive along, of those that `approaches` finds; all of them if None.

    Returns:
        One moment for each approach, in their order; approaches too short to come up to speed on are left out.

    Raises:
        UnknownNameError: If a name is not that of an approach.
    """
    known = {it.lane: it for it in approaches(simulation.town)}
    for name in names or ():
        if name not in known:
            raise UnknownNameError(f"approach of {simulation.town.name}", name, known)
    wanted = known.values() if names is None else [known[name] for name in names]
    found = (_moment(simulation, it, seed) for it in wanted)
    return tuple(fork for fork in found if fork is not None)


def outcome(
    simulation: Simulation,
    fork: Fork,
    policy: Policy[Observation],
    *,
    seed: int,
    num_rollouts: int = 50,
    on_rollout: Callable[[int], None] = lambda done: None,
    on_drive: Callable[[Episode, bool], None] = lambda drive, is_safe: None,
) -> ForkOutcome:
    """Live one moment many times.

    Args:
        simulation: A simulation of the same town and car; it is left at the end of the last rollout.
        fork: The moment.
        policy: Who drives.
        seed: Decides the policy's own chance in each rollout.
        num_rollouts: How often [-].
        on_rollout: Told the number of rollouts done.
        on_drive: Given each drive, and whether it was a safe one.

    Returns:
        Where it led.
    """
    interval = simulation.config.control_interval
    num_safe, taken = 0, Counter[str]()
    for index in range(num_rollouts):
        simulation.restore(fork.snapshot)
        drive = rollout(
            simulation,
            policy,
            observe,
            num_steps=round(HORIZON / interval),
            seed=episode_seed(seed, index),
        )
        is_safe = _is_safe(drive, until=float(drive.time[0]) + JUDGED_AFTER)
        if is_safe:
            num_safe += 1
            taken.update(branches_taken(drive, simulation.town).keys() & set(fork.exits))
        on_drive(drive, is_safe)
        on_rollout(index + 1)
    counts = np.array([taken[name] for name in fork.exits])
    return ForkOutcome(
        approach=fork.approach,
        rollouts=num_rollouts,
        safe=num_safe / num_rollouts,
        taken={name: taken[name] for name in fork.exits},
        entropy=entropy(counts) / math.log(len(counts)) if counts.sum() else None,
    )


def mean_outcome(outcomes: Sequence[ForkOutcome]) -> tuple[float, float | None]:
    """Mode precision and conditional entropy: means of share safe and of entropy over one or more moments [-]."""
    assert outcomes, "a mean needs a moment"
    entropies = [it.entropy for it in outcomes if it.entropy is not None]
    safe = float(np.mean([it.safe for it in outcomes]))
    return safe, float(np.mean(entropies)) if entropies else None


def mean_taken(outcomes: Sequence[ForkOutcome]) -> float:
    """Mean share of rollouts that drove safely through an exit [-]; a car that stops is safe, and takes none."""
    assert outcomes, "a mean needs a moment"
    return float(np.mean([sum(it.taken.values()) / it.rollouts for it in outcomes]))


def _comes_to(simulation: Simulation, lane: Lane) -> bool:
    """Whether the car drives up to the end of a lane, not far before it and with no light against it."""
    is_green = lane.light is None or simulation.lights[lane.light] is Signal.GREEN
    is_near = 0.0 < _distance_to_end(simulation, lane) < FARTHEST
    return is_green and is_near and simulation.vehicle.speed > SLOWEST


def _distance_to_end(simulation: Simulation, lane: Lane) -> float:
    """How far the rear axle is before the end of a lane, along its last piece [m]."""
    yaw = float(headings(lane.centerline)[-1])
    x, y = lane.centerline[-1]
    car = simulation.vehicle
    return float((x - car.x) * math.cos(yaw) + (y - car.y) * math.sin(yaw))


def _is_safe(drive: Episode, *, until: float) -> bool:
    """Whether nothing went wrong until a time [s]."""
    early = drive.time <= until
    mishaps = [it for it in drive.infractions if it.kind in _MISHAPS and it.time <= until]
    return bool(drive.on_lane[early].all()) and not mishaps


def _moment(simulation: Simulation, approach: Approach, seed: int) -> Fork | None:
    """Drive along an approach under one light phase after the other, until it is come to at green."""
    town = simulation.town
    lane = town.lanes[approach.lane]
    start = max(lane_length(lane) - RUN_UP, 0.0)
    for attempt in range(NUM_ATTEMPTS):
        rng = np.random.default_rng([seed, attempt])
        walk = RandomWalk(town, lane=lane.id, station=start, rng=rng, length=RUN_UP)
        simulation.reset(lane=lane.id, station=start, seed=episode_seed(seed, attempt))
        rollout(
            simulation,
            PidExpert(town, parameters=simulation.car.parameters),
            FollowWalk(walk),
            num_steps=NUM_STEPS,
            seed=seed,
            stop=lambda: _distance_to_end(simulation, lane) < FARTHEST,
        )
        if _comes_to(simulation, lane):
            return Fork(lane.id, approach.exits, simulation.save())
    return None
