"""What the lights show: a pure function of time."""

from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Signal, Town, TrafficLight

_PHASE_STREAM = 0x116475
"""Keeps the numbers drawn for lights apart from others of the same seed."""


def at(light: TrafficLight, time: float) -> Signal:
    """Tell what a light shows.

    Args:
        light: The light.
        time: Time on the clock of the lights, any sign [s].

    Returns:
        The signal; it changes exactly at the start of each stretch of the program.
    """
    position = (time + light.offset) % duration(light)
    for signal, length in light.program:
        if position < length:
            return signal
        position -= length
    return light.program[-1][0]  # rounding may leave a hair beyond the last stretch


def all_at(town: Town, time: float) -> dict[str, Signal]:
    """Tell what every light of a town shows at a time [s], by name."""
    lights = _lights_in_step(town)
    shown = [at(light, time) for light in lights.unlike]
    return {name: shown[kind] for name, kind in lights.kind.items()}


class _LightsInStep(NamedTuple):
    """Lights that change together: one of each kind, and which kind every light is of, by name."""

    unlike: tuple[TrafficLight, ...]
    kind: Mapping[str, int]


@lru_cache(maxsize=4)
def _lights_in_step(town: Town) -> _LightsInStep:
    programs = {name: (light.program, light.offset) for name, light in town.lights.items()}
    kinds = {program: index for index, program in enumerate(dict.fromkeys(programs.values()))}
    first: dict[int, TrafficLight] = {}
    for name, program in programs.items():
        first.setdefault(kinds[program], town.lights[name])
    unlike = tuple(first.values())
    return _LightsInStep(unlike, {name: kinds[program] for name, program in programs.items()})


def duration(light: TrafficLight) -> float:
    """Length of one cycle of a light [s]."""
    return sum(length for _, length in light.program)


def cycle(town: Town) -> float:
    """Length of the longest light cycle of a town [s]; 0 without lights."""
    return max((duration(light) for light in town.lights.values()), default=0.0)


def phase(town: Town, seed: int) -> float:
    """Draw where in their cycle the lights of a town are when an episode starts.

    Args:
        town: The town.
        seed: Seed of the episode.

    Returns:
        Time to add to the clock of the episode, uniform in [0, cycle) [s].
    """
    return float(np.random.default_rng([_PHASE_STREAM, seed]).uniform(0.0, cycle(town)))
