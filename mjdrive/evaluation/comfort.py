"""How smooth a drive is to sit in.

Reference:
    Balesni, Tampuu, Matiisen, Controlling Steering with Energy-Based Models, arXiv 2301.12264, 2023 (whiteness).
"""

import numpy as np
from jaxtyping import Bool

from mjdrive.datatypes import Episode
from mjdrive.evaluation.metrics import control_interval, stands


def steering_whiteness(episode: Episode) -> float:
    """Root mean square rate of the steering command, over the steps at which the car moves.

    The command counts, before any disturbance: the rack would hide what a restless policy asks of it.

    Args:
        episode: The drive.

    Returns:
        Full locks a second [1/s]; 0 for a car that never moves.
    """
    rates = np.diff(episode.labels[:, 1]) / control_interval(episode)
    return _rms(rates[_moves(episode)[1:]])


def jerk_rms(episode: Episode) -> float:
    """Root mean square jerk along the road, over the steps at which the car moves.

    Args:
        episode: The drive.

    Returns:
        Second difference of the speed [m/s3]; 0 for a car that never moves.
    """
    jerks = np.diff(episode.vehicle[:, 3], n=2) / control_interval(episode) ** 2
    return _rms(jerks[_moves(episode)[1:-1]])


def _moves(episode: Episode) -> Bool[np.ndarray, " T"]:
    return ~stands(episode)


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0
