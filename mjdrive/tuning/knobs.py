"""Which settings of an expert are tuned, and between what limits."""

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.config import MpcConfig, PidConfig
from mjdrive.errors import UnknownNameError

ExpertConfig = PidConfig | MpcConfig


class Knob(NamedTuple):
    """One number of the settings.

    Attributes:
        field: Name of the setting.
        component: Which of its numbers, or None if it is one.
        low: Least value.
        high: Largest value.
        is_log: Whether its size counts by factors.
    """

    field: str
    component: int | None
    low: float
    high: float
    is_log: bool = True


KNOBS: dict[str, tuple[Knob, ...]] = {
    "pid": (
        Knob("steering_gains", 0, 0.4, 5.0),
        Knob("steering_gains", 1, 0.005, 1.0),
        Knob("target_distance", None, 3.0, 10.0, is_log=False),
        Knob("turn_target_distance", None, 3.0, 10.0, is_log=False),
        Knob("speed_gains", 0, 0.1, 2.0),
        Knob("speed_gains", 1, 0.002, 0.3),
        Knob("brake_gain", None, 0.1, 2.0),
    ),
    "mpc": (
        Knob("offset_tolerance", None, 0.05, 2.0),
        Knob("heading_tolerance", None, 0.05, 1.0),
        Knob("steering_rate_tolerance", None, 0.03, 1.0),
        Knob("steering_jolt_tolerance", None, 0.2, 8.0),
        Knob("jerk_tolerance", None, 0.5, 10.0),
    ),
}


def default_settings(expert: str) -> ExpertConfig:
    """The settings that an expert has before it is tuned.

    Raises:
        UnknownNameError: If there is no such expert.
    """
    knobs(expert)
    return PidConfig() if expert == "pid" else MpcConfig()


def knobs(expert: str) -> tuple[Knob, ...]:
    """What is tuned of an expert.

    Raises:
        UnknownNameError: If there is no such expert.
    """
    if expert not in KNOBS:
        raise UnknownNameError("expert", expert, KNOBS)
    return KNOBS[expert]


def turned(
    config: ExpertConfig, chosen: Sequence[Knob], places: Float[np.ndarray, " K"]
) -> ExpertConfig:
    """Set every knob.

    Args:
        config: Settings to change.
        chosen: Knobs of these settings.
        places: Where each stands between its limits; 0 is the least, 1 the largest value [-].

    Returns:
        The changed settings, their numbers rounded to four digits.
    """
    changes: dict[str, object] = {}
    for knob, place in zip(chosen, places, strict=True):
        value = _value(knob, float(np.clip(place, 0.0, 1.0)))
        if knob.component is None:
            changes[knob.field] = value
        else:
            numbers = list(changes.get(knob.field, getattr(config, knob.field)))  # type: ignore[call-overload]
            numbers[knob.component] = value
            changes[knob.field] = tuple(numbers)
    return dataclasses.replace(config, **changes)  # type: ignore[arg-type]


def places_of(config: ExpertConfig, chosen: Sequence[Knob]) -> Float[np.ndarray, " K"]:
    """Where the knobs of some settings stand between their limits, in [0, 1] [-]; the inverse of `turned`."""
    return np.array([_place(knob, _read(config, knob)) for knob in chosen])


def _read(config: ExpertConfig, knob: Knob) -> float:
    value = getattr(config, knob.field)
    return float(value if knob.component is None else value[knob.component])


def _value(knob: Knob, place: float) -> float:
    low, high = (np.log([knob.low, knob.high])) if knob.is_log else (knob.low, knob.high)
    value = low + place * (high - low)
    return float(f"{np.exp(value) if knob.is_log else value:.4g}")


def _place(knob: Knob, value: float) -> float:
    clipped = np.clip(value, knob.low, knob.high)
    if knob.is_log:
        return float(np.log(clipped / knob.low) / np.log(knob.high / knob.low))
    return float((clipped - knob.low) / (knob.high - knob.low))
