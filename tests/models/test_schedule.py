import pytest

from models.config import OptimiserConfig
from models.schedule import learning_rate

ONE_CYCLE = OptimiserConfig(learning_rate=6e-4, schedule="onecycle")


def test_a_constant_schedule_never_changes():
    config = OptimiserConfig(learning_rate=1e-5)
    assert {learning_rate(step, 50, config) for step in range(50)} == {1e-5}


def test_one_cycle_rises_once_and_falls_once_between_its_ends():
    rates = [learning_rate(step, 1000, ONE_CYCLE) for step in range(1000)]
    top = rates.index(max(rates))
    assert rates[0] == pytest.approx(6e-4 / 25)
    assert (top, rates[top]) == (299, pytest.approx(6e-4))
    assert rates[-1] == pytest.approx(6e-4 / 25e4)
    assert rates[: top + 1] == sorted(rates[: top + 1])
    assert rates[top:] == sorted(rates[top:], reverse=True)


@pytest.mark.parametrize("num_steps", [1, 2, 3])
def test_the_shortest_runs_have_a_positive_step_size(num_steps):
    assert all(0 < learning_rate(i, num_steps, ONE_CYCLE) <= 6e-4 for i in range(num_steps))
