"""Two ways of the same work, timed in turns: A B A B, so that other work on the machine falls on both alike."""

import statistics
import time
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

Work = Callable[[], object]
Clock = Callable[[], float]

WALL: Clock = time.perf_counter
"""What a user waits for; the clock where several threads or processes work [s]."""

CPU: Clock = time.process_time
"""Processor time of all threads of this process; a busy machine troubles it less [s]."""

THREAD: Clock = time.thread_time
"""Processor time of this thread alone; the clock of work on one core [s]."""


class Pair(NamedTuple):
    """Rounds of both sides; round i of one ran beside round i of the other.

    Attributes:
        ours: Of our side, by the clock that was asked for [s].
        theirs: Of the other side [s].
    """

    ours: tuple[float, ...]
    theirs: tuple[float, ...]


def paired(ours: Work, theirs: Work, *, rounds: int, warm_up: int = 1, clock: Clock = WALL) -> Pair:
    """Time two ways of the same work in turns.

    Args:
        ours: One round of our side.
        theirs: One round of the other side, as much work.
        rounds: Rounds of each that count [-].
        warm_up: Rounds of each before that, which do not [-].
        clock: What tells the time [s].

    Returns:
        What every round took.
    """
    taken: tuple[list[float], list[float]] = ([], [])
    for number in range(warm_up + rounds):
        for side, work in zip(taken, (ours, theirs), strict=True):
            seconds = timed(work, clock)
            if number >= warm_up:
                side.append(seconds)
    return Pair(tuple(taken[0]), tuple(taken[1]))


def alone(work: Work, *, rounds: int, warm_up: int = 1, clock: Clock = WALL) -> tuple[float, ...]:
    """Time one way of work round by round.

    Args:
        work: One round.
        rounds: Rounds that count [-].
        warm_up: Rounds before that, which do not [-].
        clock: What tells the time [s].

    Returns:
        What every round took [s].
    """
    for _ in range(warm_up):
        work()
    return tuple(timed(work, clock) for _ in range(rounds))


def timed(work: Work, clock: Clock = WALL) -> float:
    """Do some work and tell what it took [s]."""
    begin = clock()
    work()
    return clock() - begin


def cost_of(clock: Clock) -> float:
    """Tell what it takes to ask a clock once, which every time between two of its answers has in it [s]."""
    answers = [clock() for _ in range(1001)]
    return statistics.median(later - earlier for earlier, later in pairwise(answers))
