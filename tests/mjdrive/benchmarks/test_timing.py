import itertools

import pytest

from mjdrive.benchmarks.timing import alone, paired, timed


class FakeClock:
    """A clock that moves on only when work says so."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> FakeClock:
    return FakeClock()


def work(clock: FakeClock, seconds: list[float], log: list[str], name: str):
    rounds = itertools.cycle(seconds)

    def do() -> None:
        log.append(name)
        clock.now += next(rounds)

    return do


def test_two_sides_take_turns_and_each_round_is_timed(clock: FakeClock) -> None:
    log: list[str] = []
    ours, theirs = work(clock, [1.0, 2.0, 4.0], log, "A"), work(clock, [8.0, 16.0, 32.0], log, "B")
    pair = paired(ours, theirs, rounds=2, warm_up=1, clock=clock)
    assert log == ["A", "B"] * 3
    assert pair.ours == (2.0, 4.0)
    assert pair.theirs == (16.0, 32.0)


def test_warm_up_does_not_count(clock: FakeClock) -> None:
    log: list[str] = []
    assert alone(work(clock, [9.0, 9.0, 1.0], log, "A"), rounds=1, warm_up=2, clock=clock) == (1.0,)
    assert len(log) == 3


def test_time_is_that_of_the_work_alone(clock: FakeClock) -> None:
    clock.now = 100.0
    assert timed(work(clock, [0.25], [], "A"), clock) == 0.25
