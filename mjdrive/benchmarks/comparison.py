"""What a benchmark finds out: a ratio of two sides, a figure against a bar, or why there is neither."""

import math
import statistics
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import NamedTuple

from mjdrive.errors import ConfigError


class Spread(NamedTuple):
    """A median with the middle half around it.

    Attributes:
        low: Lower quartile, in the unit of the values.
        median: In the unit of the values.
        high: Upper quartile, in the unit of the values.
    """

    low: float
    median: float
    high: float


class Reads(StrEnum):
    """How the ratio of a comparison is to be read."""

    FASTER = "faster"  # theirs / ours of seconds; the bar is the least
    SMALLER = "smaller"  # theirs / ours of bytes; the bar is the least
    COST = "cost"  # ours / theirs of seconds; the bar is the most


@dataclass(frozen=True, slots=True)
class Comparison:
    """The same work done our way and another way, in turns.

    Round i of one side ran beside round i of the other, so ratios are taken pair by pair.

    Attributes:
        name: Of the row.
        work: What both sides do.
        ours: What our side is.
        theirs: What the other side is.
        our_rounds: What each of our rounds took; smaller is better, in `unit`.
        their_rounds: What each of theirs took, in `unit`.
        bar: Least ratio that is good enough, or the greatest where `reads` is a cost [-].
        reads: How the ratio is to be read.
        unit: Of the rounds.
        pieces: Pieces of work a round; rounds are shown a piece [-].
        piece: What one of them is called.
        note: What a reader of the ratio should know.
    """

    name: str
    work: str
    ours: str
    theirs: str
    our_rounds: tuple[float, ...]
    their_rounds: tuple[float, ...]
    bar: float
    reads: Reads = Reads.FASTER
    unit: str = "s"
    pieces: float = 1.0
    piece: str = "round"
    note: str = ""

    def __post_init__(self) -> None:
        if len(self.our_rounds) != len(self.their_rounds) or not self.our_rounds:
            raise ConfigError(
                f"Benchmark '{self.name}' has {len(self.our_rounds)} rounds of ours and {len(self.their_rounds)} of "
                f"theirs; expected pairs, at least one."
            )

    @property
    def ratio(self) -> Spread:
        """Of the pairs of rounds [-]."""
        pairs = zip(self.our_rounds, self.their_rounds, strict=True)
        if self.reads is Reads.COST:
            return spread([ours / theirs for ours, theirs in pairs])
        return spread([theirs / ours for ours, theirs in pairs])

    @property
    def our_piece(self) -> float:
        """Median of what a piece of work takes us, in `unit`."""
        return statistics.median(self.our_rounds) / self.pieces

    @property
    def their_piece(self) -> float:
        """Median of what a piece of work takes them, in `unit`."""
        return statistics.median(self.their_rounds) / self.pieces

    @property
    def holds(self) -> bool:
        """Whether the median ratio reaches the bar."""
        median = self.ratio.median
        return median <= self.bar if self.reads is Reads.COST else median >= self.bar


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure of ours alone against a bar.

    Attributes:
        name: Of the row.
        work: What is measured.
        rounds: The figure in each round, in `unit`.
        unit: Such as "ms" or "MB".
        most: Largest median that is good enough, in `unit`; None if any is.
        least: Smallest median that is good enough, in `unit`; None if any is.
        note: What a reader of the figure should know.
    """

    name: str
    work: str
    rounds: tuple[float, ...]
    unit: str
    most: float | None = None
    least: float | None = None
    note: str = ""

    @property
    def value(self) -> Spread:
        """Of the rounds, in `unit`."""
        return spread(self.rounds)

    @property
    def holds(self) -> bool:
        """Whether the median lies within its limits; what is no number never does."""
        median = self.value.median
        return (
            math.isfinite(median)
            and (self.most is None or median <= self.most)
            and (self.least is None or median >= self.least)
        )


@dataclass(frozen=True, slots=True)
class NotMeasured:
    """A row that could not be measured on this machine.

    Attributes:
        name: Of the row.
        work: What would have been measured.
        reason: What is missing.
        command: What makes it possible.
    """

    name: str
    work: str
    reason: str
    command: str


Row = Comparison | Figure | NotMeasured


@dataclass(frozen=True, slots=True)
class Plan:
    """What a benchmark is handed: how much to measure, and where things are.

    Attributes:
        workspace: Folder that all benchmarks of a run share; what one leaves there (a data set, say) another may use.
        quick: Measure the least that gives every row; the figures are then only a look.
        rivals: Folder with the environments of the rivals; None if there is none.
        on_stage: To be called with a few words when something new begins.
    """

    workspace: Path
    quick: bool = False
    rivals: Path | None = None
    on_stage: Callable[[str], None] = lambda stage: None

    def rounds(self, full: int) -> int:
        """Rounds to measure where a full run has so many [-]."""
        return min(full, 2) if self.quick else full


def spread(values: tuple[float, ...] | list[float]) -> Spread:
    """Take median and quartiles.

    Args:
        values: At least one.
    """
    if len(values) == 1:
        return Spread(values[0], values[0], values[0])
    low, median, high = statistics.quantiles(values, n=4, method="inclusive")
    return Spread(low, median, high)
