"""The steering wheel in a page: who holds it, which keys are down, and the action that they amount to."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from mjdrive.datatypes import Action

LETS_GO_AFTER = 0.5
"""Without a word from the page, whose tab may be gone or busy [s]."""

STEERING_PER_S = 1.6
CENTRING_PER_S = 2.6
PEDAL_PER_S = 3.0
"""How fast keys move the commands [1/s]."""


@dataclass(frozen=True, slots=True)
class Held:
    """What a person last said.

    Attributes:
        keys: Keys that are down.
        analog: Acceleration and steering of a gamepad, in its place.
        seq: Number of the message [-].
        at: When it came, by the clock of the server [s].
    """

    keys: frozenset[str] = frozenset()
    analog: tuple[float, float] | None = None
    seq: int = 0
    at: float = float("-inf")


class Wheel:
    """One holder at a time; everything is let go where the page falls silent.

    Args:
        clock: Tells the time [s].

    Attributes:
        holder: Who holds it, or None.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.holder: object | None = None
        self._clock = clock
        self._held = Held()
        self._action = Action(0.0, 0.0)

    def take(self, who: object) -> bool:
        """Take it if it is free; whether it is theirs now."""
        if self.holder is None:
            self.holder, self._held = who, Held()
            self._action = Action(0.0, 0.0)
        return self.holder is who

    def give_back(self, who: object) -> bool:
        """Give it back; whether it was theirs."""
        if self.holder is not who:
            return False
        self.holder = None
        return True

    def say(
        self,
        who: object,
        *,
        keys: frozenset[str] = frozenset(),
        analog: tuple[float, float] | None = None,
        seq: int = 0,
    ) -> None:
        """Hear which keys are down; nobody listens to those who do not hold the wheel."""
        if self.holder is who:
            self._held = Held(keys, analog, seq, self._clock())

    @property
    def seq(self) -> int:
        """Number of the message that is driven by [-]."""
        return self._held.seq

    def action(self, interval: float) -> Action:
        """Move the commands for one control interval [s] towards what is held."""
        if self._clock() - self._held.at > LETS_GO_AFTER:
            keys, analog = frozenset[str](), None
        else:
            keys, analog = self._held.keys, self._held.analog
        if analog is not None:
            self._action = Action(*analog)
            return self._action
        turn = ("left" in keys) - ("right" in keys)
        drive = -1 if "brake" in keys else ("up" in keys) - ("down" in keys)
        was = self._action
        rate = STEERING_PER_S if turn * was.steering >= 0 and turn else CENTRING_PER_S
        pedal = 0.0 if drive * was.acceleration < 0 else was.acceleration
        self._action = Action(
            acceleration=_towards(pedal, float(drive), PEDAL_PER_S * interval),
            steering=_towards(was.steering, float(turn), rate * interval),
        )
        return self._action


def _towards(value: float, target: float, most: float) -> float:
    """Move a command towards another by so much at most [-]."""
    return value + min(max(target - value, -most), most)
