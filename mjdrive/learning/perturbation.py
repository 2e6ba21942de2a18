"""Demonstrations seen from beside where they were driven, with the steering that leads back.

Views are drawn from states, so a car that was moved sees exactly what it would see there. What it should do there is not
in the demonstration: it is reckoned from how the PID expert steers.
"""

import dataclasses

import numpy as np
from jaxtyping import Float

from mjdrive.config import PidConfig
from mjdrive.datatypes import Episode
from models.config import PerturbationConfig

SLOWEST = 1.0
"""Slower pairs stay as they are [m/s]: who stands or begins to drive has come there, and the expert does not steer meanwhile."""


def perturb(
    episode: Episode,
    config: PerturbationConfig,
    rng: np.random.Generator,
    *,
    expert: PidConfig | None = None,
) -> Episode:
    """Move the car of some moments to the side and turn it, each by its own chance, and let the label lead back.

    The steering changes by as much as the PID expert's would whose target point, some metres on, lies on the way that was
    driven: by its proportional gain times the change of the angle to that point. Acceleration stays, as that expert does
    not slow down for so little (`PidConfig.recovery_offset`), and so do speed and what was driven before.

    Args:
        episode: A drive; one that is not disturbed, or it is disturbed twice.
        config: How many moments, and how far.
        rng: Source of randomness; it draws as many numbers for every share.
        expert: Gain and distance of the target point; the defaults if None.

    Returns:
        The same drive with other poses and labels; for learning alone, as nobody has driven it.
    """
    expert = expert or PidConfig()
    chance, side, turn = rng.uniform(-1.0, 1.0, (3, len(episode.time)))
    is_moved = (np.abs(chance) < config.share) & (episode.vehicle[:, 3] >= SLOWEST)
    offset = np.where(is_moved, config.offset * side, 0.0)
    heading = np.where(is_moved, config.heading * turn, 0.0)
    poses = episode.vehicle[:, :3]
    yaw = poses[:, 2]
    moved = poses + np.column_stack((-np.sin(yaw) * offset, np.cos(yaw) * offset, heading))
    targets = _targets(poses, expert.target_distance)
    change = _angles_to(targets, moved) - _angles_to(targets, poses)
    steering = episode.labels[:, 1] + expert.steering_gains[0] * change
    return dataclasses.replace(
        episode,
        vehicle=np.column_stack((moved, episode.vehicle[:, 3:])),
        labels=np.column_stack((episode.labels[:, 0], np.clip(steering, -1.0, 1.0))),
    )


def _targets(poses: Float[np.ndarray, "T 3"], distance: float) -> Float[np.ndarray, "T 2"]:
    """The point of the way that lies so far ahead [m]; the way goes straight on where the drive ends."""
    x, y, yaw = poses[-1]
    beyond = np.array([x + distance * np.cos(yaw), y + distance * np.sin(yaw)])
    way = np.vstack((poses[:, :2], beyond))
    station = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))))
    wanted = station[:-1] + distance
    return np.column_stack([np.interp(wanted, station, axis) for axis in way.T])


def _angles_to(
    points: Float[np.ndarray, "T 2"], poses: Float[np.ndarray, "T 3"]
) -> Float[np.ndarray, " T"]:
    """Angle from the heading of each pose to its point, positive to the left [rad]."""
    dx, dy = (points - poses[:, :2]).T
    cos, sin = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    return np.arctan2(cos * dy - sin * dx, cos * dx + sin * dy)
