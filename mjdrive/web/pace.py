"""Keeps a simulation in step with the clock, and lets it fall behind where it is too slow."""

import time
from collections.abc import Callable

MOST_BEHIND = 0.2
"""Further than this behind, the lost time is given up [s]."""

ENOUGH = 0.95
"""Of the rate that is asked for; below it, the simulation is late [-]."""

FORGETTING = 0.98
"""Of the measured rate, at each beat [-]."""


class Pace:
    """Waits between the beats of a simulation.

    Args:
        clock: Tells the time [s].
        sleep: Waits so long [s].

    Attributes:
        factor: Simulated over real time that is asked for [-].
        rate: What is reached [-].
    """

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.factor = self.rate = 1.0
        self._clock, self._sleep = clock, sleep
        self.restart()

    def restart(self) -> None:
        """Begin now; what was missed during a pause is not made up."""
        self._due = self._last = self._clock()

    def beat(self, interval: float) -> None:
        """Wait until so much simulated time [s] may have passed since the last beat."""
        self._due += interval / self.factor
        now = self._clock()
        if now < self._due:
            self._sleep(self._due - now)
        elif now - self._due > MOST_BEHIND:
            self._due = now
        now = self._clock()
        passed = max(now - self._last, 1e-6)
        self._last = now
        # Of times, not of rates: one short beat after a long one must not count as a fast simulation.
        mean = FORGETTING / self.rate + (1.0 - FORGETTING) * passed / interval
        self.rate = 1.0 / mean

    @property
    def is_late(self) -> bool:
        """Whether the simulation does not keep up, so that what can be left out should be."""
        return self.rate < ENOUGH * self.factor
