import pytest

from mjdrive.benchmarks import machine
from mjdrive.benchmarks.machine import Neighbours


def test_neighbours_are_what_all_worked_less_our_own(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, busy, own = [100.0], [50.0], [7.0]
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    monkeypatch.setattr(machine, "_busy_s", lambda: busy[0])
    monkeypatch.setattr(machine, "_own_s", lambda: own[0])
    neighbours = Neighbours()
    clock[0], busy[0], own[0] = 110.0, 65.0, 10.0
    assert neighbours.cores() == pytest.approx(1.2)


def test_where_the_machine_does_not_tell_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "_busy_s", lambda: -1.0)
    assert Neighbours().cores() == -1.0


def test_work_of_this_process_is_part_of_what_all_worked() -> None:
    if machine._busy_s() < 0.0:
        pytest.skip("this system does not tell what its processors do")
    all_before, own_before = machine._busy_s(), machine._own_s()
    sum(range(20_000_000))
    own = machine._own_s() - own_before
    assert own > 0.05
    assert machine._busy_s() - all_before > own - 0.05  # both are counted in ticks of some 10 ms
