"""Who is in control: the first page that came; the others watch, and can ask for control."""

import time
from collections.abc import Callable
from typing import NamedTuple

ANSWERS_WITHIN = 20.0
"""Who is asked for control and says nothing for so long has gone; a page left open must not keep all others out [s]."""


class Standing(NamedTuple):
    """Who is what now.

    Attributes:
        operator: Who is in control, or None.
        asking: Those who ask for control, the first one first.
        driver: Who holds the wheel, or None.
    """

    operator: object | None = None
    asking: tuple[object, ...] = ()
    driver: object | None = None


class Roles:
    """One operator, the others in the order in which they came.

    Args:
        clock: Tells the time [s].

    Attributes:
        operator: Who is in control, or None.
        asking: Those who ask for control, the first one first.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.operator: object | None = None
        self.asking: tuple[object, ...] = ()
        self._watchers: list[object] = []
        self._clock = clock
        self._asked_at = 0.0

    def come(self, who: object) -> None:
        """Take control if nobody has it, else watch."""
        self._watchers.append(who)
        if self.operator is None:
            self.hand_over()

    def leave(self, who: object) -> None:
        """Go; control goes to the next one."""
        self.asking = tuple(it for it in self.asking if it is not who)
        if self.operator is who:
            self.operator = None
            self.hand_over()
        elif who in self._watchers:
            self._watchers.remove(who)

    def ask(self, who: object) -> None:
        """Ask for control; of the one who has it, a word to those who ask: no."""
        if who is self.operator:
            self.asking = ()
        elif who in self._watchers and who not in self.asking:
            self._asked_at = self._asked_at if self.asking else self._clock()
            self.asking = (*self.asking, who)

    def take_back(self, who: object) -> None:
        """No longer ask; of the one in control: hand over to somebody else."""
        if who is self.operator:
            self.hand_over()
        self.asking = tuple(it for it in self.asking if it is not who)

    def hand_over(self) -> None:
        """Give control to the first who asks, or else to the one who has watched longest."""
        waiting = (*self.asking, *self._watchers)
        if not waiting:
            return
        if self.operator is not None:
            self._watchers.append(self.operator)
        self.operator = waiting[0]
        self._watchers.remove(waiting[0])
        self.asking = ()

    @property
    def is_unanswered(self) -> bool:
        """Whether somebody has asked in vain for too long."""
        return bool(self.asking) and self._clock() - self._asked_at > ANSWERS_WITHIN
