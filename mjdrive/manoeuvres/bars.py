"""What is asked of the car, as data: a figure, what was measured, and between which limits it must lie."""

import math
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Bar:
    """A figure of the car and its limits.

    Attributes:
        manoeuvre: What was driven.
        figure: What was measured.
        measured: Its value, in `unit`.
        unit: Such as "m" or "deg/g".
        least: Smallest value that is good enough, in `unit`; None if any is.
        most: Largest value that is good enough, in `unit`; None if any is.
        reason: Where the limits come from.
    """

    manoeuvre: str
    figure: str
    measured: float
    unit: str
    least: float | None = None
    most: float | None = None
    reason: str = ""

    @property
    def holds(self) -> bool:
        """Whether the figure lies within its limits; what is no number never does."""
        return (
            math.isfinite(self.measured)
            and (self.least is None or self.measured >= self.least)
            and (self.most is None or self.measured <= self.most)
        )


def around(value: float, share: float) -> dict[str, float]:
    """Limits a share of a value to either side of it.

    Args:
        value: The middle.
        share: Of its size [-].

    Returns:
        `least` and `most` of a bar.
    """
    margin = share * abs(value)
    return {"least": value - margin, "most": value + margin}


def failed(bars: Iterable[Bar]) -> tuple[Bar, ...]:
    """The bars that do not hold."""
    return tuple(bar for bar in bars if not bar.holds)
