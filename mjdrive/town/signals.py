"""What the lights show: a pure function of time."""

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Signal, Town, TrafficLight

_MOST_KEPT = 256
"""States of all lights of a town that are kept; a cycle of town02 has far fewer [-]."""

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
    return Cycle.of(light).at(time)


def turns_green(light: TrafficLight) -> bool:
    """Tell whether a light ever lets anyone pass."""
    return any(signal is Signal.GREEN and time > 0 for signal, time in light.program)


def in_words(light: TrafficLight) -> str:
    """What a light shows, and for how long each, as in "green 10 s, yellow 3 s, red 47 s"."""
    return ", ".join(f"{signal.name.lower()} {time:g} s" for signal, time in light.program)


class Cycle(NamedTuple):
    """When a light shows what, ready to be asked often.

    Attributes:
        program: Signals and how long each is shown [s].
        offset: Time into the cycle at clock zero [s].
        duration: Of all of it [s].
    """

    program: tuple[tuple[Signal, float], ...]
    offset: float
    duration: float

    @staticmethod
    def of(light: TrafficLight) -> "Cycle":
        """The cycle of a light; lights with equal ones change together."""
        return Cycle(light.program, light.offset, duration(light))

    def at(self, time: float) -> Signal:
        """Tell what the light shows at a time on the clock of the lights [s]; see `at`."""
        position = (time + self.offset) % self.duration
        for signal, length in self.program:
            if position < length:
                return signal
            position -= length
        return self.program[-1][0]  # rounding may leave a hair beyond the last stretch


def all_at(town: Town, time: float) -> Mapping[str, Signal]:
    """Tell what every light of a town shows at a time [s], by name.

    Returns:
        What is shown; the same object while it lasts.
    """
    return _lights_in_step(town).at(time)


class _LightsInStep:
    """Lights that change together: the cycle of each kind, and which kind every light is of, by name."""

    def __init__(self, town: Town) -> None:
        cycles = {name: Cycle.of(light) for name, light in town.lights.items()}
        kinds = {cycle: index for index, cycle in enumerate(dict.fromkeys(cycles.values()))}
        self._unlike = tuple(kinds)
        self._kind = {name: kinds[cycle] for name, cycle in cycles.items()}
        self._by_name: dict[bytes, Mapping[str, Signal]] = {}

    def at(self, time: float) -> Mapping[str, Signal]:
        """What every light shows at a time [s]; see `all_at`."""
        shown = bytes([cycle.at(time) for cycle in self._unlike])  # found faster than signals
        found = self._by_name.get(shown)
        if found is None:
            if len(self._by_name) == _MOST_KEPT:
                self._by_name.clear()
            every = {name: Signal(shown[kind]) for name, kind in self._kind.items()}
            found = self._by_name[shown] = MappingProxyType(every)
        return found


@lru_cache(maxsize=4)
def _lights_in_step(town: Town) -> _LightsInStep:
    return _LightsInStep(town)


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
