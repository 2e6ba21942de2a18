"""What a trial is worth."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mjdrive.config import TuneConfig
from mjdrive.datatypes import InfractionKind
from mjdrive.evaluation import comfort
from mjdrive.evaluation.metrics import control_interval
from mjdrive.tuning.course import Trace

REFERENCE_SPEED = 6.0
"""Speed of the paper's expert on straight roads, which nobody is slow against [m/s]."""


@dataclass(frozen=True, slots=True)
class Marks:
    """How one set of settings drove the course.

    Attributes:
        offset_rms_m: Root mean square distance from the route [m].
        offset_max_m: Largest distance from the route in exercises that begin on it [m].
        steering_whiteness: Of the steering command [1/s].
        jerk_rms: Of the forward speed [m/s3].
        duration_s: Time for all exercises [s].
        slowness: Time beyond that at 6 m/s throughout, as a share of it [-].
        mishaps: Infractions, red lights aside, and exercises not finished [-].
        cost: Sum of offset, whiteness, jerk, slowness and mishaps, each over its scale [-].
    """

    offset_rms_m: float
    offset_max_m: float
    steering_whiteness: float
    jerk_rms: float
    duration_s: float
    slowness: float
    mishaps: int
    cost: float


def judge(traces: Sequence[Trace], config: TuneConfig) -> Marks:
    """Mark one trial.

    Args:
        traces: Its exercises; the last one begins beside the route.
        config: What each mark costs.
    """
    interval = control_interval(traces[0].episode)
    offsets = np.concatenate([trace.offsets for trace in traces])
    on_route = np.concatenate([trace.offsets for trace in traces[:-1]])
    duration = interval * len(offsets)
    slowness = duration * REFERENCE_SPEED / sum(trace.length for trace in traces) - 1.0
    drives = [comfort.comfort(trace.episode, interval=interval) for trace in traces]
    whiteness = _rms([drive.steering_whiteness for drive in drives])
    jerk = _rms([drive.jerk_rms for drive in drives])
    offset = float(np.sqrt(np.mean(offsets**2)))
    mishaps = sum(map(_mishaps, traces))
    cost = (
        offset / config.offset_scale
        + whiteness / config.whiteness_scale
        + jerk / config.jerk_scale
        + max(slowness, 0.0) / config.slowness_scale
        + config.mishap_cost * mishaps
    )
    return Marks(
        offset_rms_m=round(offset, 4),
        offset_max_m=round(float(np.abs(on_route).max()), 4),
        steering_whiteness=round(whiteness, 4),
        jerk_rms=round(jerk, 4),
        duration_s=round(duration, 1),
        slowness=round(slowness, 4),
        mishaps=mishaps,
        cost=round(cost, 4),
    )


def _mishaps(trace: Trace) -> int:
    """Infractions of one exercise, and 1 more if it was not finished; its lights are green to the expert."""
    kinds = [infraction.kind for infraction in trace.episode.infractions]
    return sum(kind is not InfractionKind.RED_LIGHT for kind in kinds) + (not trace.is_finished)


def _rms(values: Sequence[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
