"""A simulation keeps step with the clock, and gives lost time up."""

import pytest

from mjdrive.web.pace import Pace


class Time:
    """Time that passes when somebody sleeps."""

    now = 0.0

    def clock(self) -> float:
        return self.now

    def sleep(self, duration: float) -> None:
        self.now += duration


@pytest.mark.parametrize("factor", [0.25, 1.0, 8.0])
def test_simulated_time_passes_by_the_factor(factor: float) -> None:
    time = Time()
    pace = Pace(time.clock, time.sleep)
    pace.factor = factor
    for _ in range(500):
        pace.beat(0.02)
    assert time.now == pytest.approx(500 * 0.02 / factor)
    assert pace.rate == pytest.approx(factor, rel=0.01)


def test_a_slow_simulation_is_not_rushed_afterwards() -> None:
    time = Time()
    pace = Pace(time.clock, time.sleep)
    time.now += 10.0
    pace.beat(0.02)
    before = time.now
    pace.beat(0.02)
    assert time.now == pytest.approx(before + 0.02)


def test_a_simulation_that_cannot_keep_up_says_so() -> None:
    time = Time()
    pace = Pace(time.clock, lambda duration: None)
    for _ in range(500):
        time.now += 0.04
        pace.beat(0.02)
    assert pace.rate == pytest.approx(0.5, rel=0.01)
