"""One moment before a junction, lived many times: the ways that the car took, to be drawn over the map."""

from collections.abc import Callable
from dataclasses import dataclass

from mjdrive.datatypes import Episode, Observation, Policy, Town
from mjdrive.evaluation import forking, metrics
from mjdrive.evaluation.branches import branches_taken
from mjdrive.evaluation.forking import Fork, ForkOutcome
from mjdrive.simulation.simulation import Simulation

POINT_INTERVAL = 0.5
"""Time between two points of the path of a drive through the town [s]."""

FAN_INTERVAL = 0.2
"""The same of a path through one junction [s]."""


@dataclass(frozen=True, slots=True)
class FanPath:
    """One of many drives from the same moment.

    Attributes:
        exit: Name of the junction lane that was driven to its end; empty if none was.
        is_safe: Whether it stayed on the road and hit nothing for as long as that is judged.
        points: Rear axle five times a second, world frame [m].
    """

    exit: str
    is_safe: bool
    points: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class FanRecord:
    """One moment before a junction, lived many times by one agent.

    Attributes:
        arm: Name of the arm.
        seed: Training seed [-].
        town: Where.
        approach: Name of the lane that the car was on.
        exits: Names of the junction lanes that lead on from it.
        paths: One a rollout.
    """

    arm: str
    seed: int
    town: str
    approach: str
    exits: tuple[str, ...]
    paths: tuple[FanPath, ...]


def live(
    simulation: Simulation,
    fork: Fork,
    policy: Policy[Observation],
    *,
    arm: str,
    agent_seed: int,
    seed: int,
    num_rollouts: int = 50,
    on_rollout: Callable[[int], None] = lambda done: None,
    on_drive: Callable[[Episode, bool], None] = lambda drive, is_safe: None,
) -> tuple[ForkOutcome, FanRecord]:
    """Live one moment many times, and keep the ways that the car took.

    Args:
        simulation: A simulation of the same town and car; it is left at the end of the last rollout.
        fork: The moment.
        policy: Who drives.
        arm: Name of the arm, for the record.
        agent_seed: Training seed of the agent, for the record [-].
        seed: Decides the policy's own chance in each rollout.
        num_rollouts: How often [-].
        on_rollout: Told the number of rollouts done.
        on_drive: Given each drive, and whether it was a safe one.

    Returns:
        What `mjdrive.evaluation.forking.outcome` counts, and the paths.
    """
    paths: list[FanPath] = []

    def keep(drive: Episode, is_safe: bool) -> None:
        taken = exit_of(drive, fork, simulation.town)
        paths.append(FanPath(exit=taken, is_safe=is_safe, points=thinned_path(drive, FAN_INTERVAL)))
        on_drive(drive, is_safe)

    outcome = forking.outcome(
        simulation,
        fork,
        policy,
        seed=seed,
        num_rollouts=num_rollouts,
        on_rollout=on_rollout,
        on_drive=keep,
    )
    record = FanRecord(
        arm=arm,
        seed=agent_seed,
        town=simulation.town.name,
        approach=fork.approach,
        exits=fork.exits,
        paths=tuple(paths),
    )
    return outcome, record


def exit_of(drive: Episode, fork: Fork, town: Town) -> str:
    """Name of the junction lane that a drive from a moment took to its end; empty if it took none."""
    return min(branches_taken(drive, town).keys() & set(fork.exits), default="")


def thinned_path(
    drive: Episode, interval: float = POINT_INTERVAL, *, steps: int | None = None
) -> tuple[tuple[float, float], ...]:
    """Where the rear axle was every so often [s], in so many control steps or all, to the centimetre, world frame [m]."""
    step = max(1, round(interval / metrics.control_interval(drive)))
    return tuple((round(x, 2), round(y, 2)) for x, y in drive.vehicle[:steps:step, :2].tolist())
