"""How smoothly a drive went: the jerk of the car and the unrest of the steering command.

Reference:
    Eraqi, Moustafa, Honer, End-to-End Deep Learning for Steering Autonomous Vehicles Considering Temporal Dependencies,
    2017, and Balesni et al., Controlling Steering with Energy-Based Models, 2023 (whiteness).
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Episode


@dataclass(frozen=True, slots=True)
class Comfort:
    """The figures of a drive, standstill included.

    Attributes:
        jerk_rms: Root mean square of the second difference of the speed [m/s3].
        steering_whiteness: Root mean square of the rate of the steering command, as published [1/s]. Most of it is the
            turns themselves, which every driver has to steer.
        steering_unrest: Root mean square of the rate of that rate [1/s2]: what is left if the turns are steered evenly.
    """

    jerk_rms: float
    steering_whiteness: float
    steering_unrest: float


def comfort(episode: Episode, *, interval: float) -> Comfort:
    """Measure how smoothly a policy drove; its own commands count, not a disturbance of them.

    Args:
        episode: The drive.
        interval: Time between two steps [s].

    Returns:
        Its figures.
    """
    steering = episode.labels[:, 1]
    return Comfort(
        jerk_rms=jerk_rms(episode.vehicle[:, 3], interval=interval),
        steering_whiteness=steering_whiteness(steering, interval=interval),
        steering_unrest=steering_unrest(steering, interval=interval),
    )


def jerk_rms(speed: Float[np.ndarray, " T"], *, interval: float) -> float:
    """Root mean square of the jerk [m/s3] of speeds [m/s] that lie an interval [s] apart; 0 for fewer than three."""
    return _rms(np.diff(speed, 2)) / interval**2


def steering_whiteness(steering: Float[np.ndarray, " T"], *, interval: float) -> float:
    """Root mean square of the rate [1/s] of steering commands [-] that lie an interval [s] apart; 0 for fewer than two."""
    return _rms(np.diff(steering)) / interval


def steering_unrest(steering: Float[np.ndarray, " T"], *, interval: float) -> float:
    """Root mean square of the second rate [1/s2] of steering commands [-] an interval [s] apart; 0 for fewer than three."""
    return _rms(np.diff(steering, 2)) / interval**2


def _rms(values: Float[np.ndarray, " T"]) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0
