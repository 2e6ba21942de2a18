import sys
from pathlib import Path

import pytest

from mjdrive.benchmarks import watching
from mjdrive.benchmarks.comparison import NotMeasured, Plan
from mjdrive.benchmarks.suite import choose
from mjdrive.errors import MissingPackageError, WorkerError


class Time:
    """Time that passes when somebody sleeps, and steps that are taken meanwhile."""

    now = 0.0

    def clock(self) -> float:
        return self.now

    def sleep(self, duration: float) -> None:
        self.now += duration

    def progress(self) -> watching.Progress:
        return watching.Progress(round(self.now / 0.02), 0.25 * self.now)


def test_steps_that_somebody_else_takes_are_timed() -> None:
    time = Time()
    found = watching.step_time(time.progress, 3.0, clock=time.clock, sleep=time.sleep)
    assert found == pytest.approx((0.02, 0.005))


def test_a_server_that_stands_still_is_no_figure() -> None:
    time, still = Time(), watching.Progress(7, 1.0)
    with pytest.raises(WorkerError, match=r"no control step in 3 s; expected some"):
        watching.step_time(lambda: still, 3.0, clock=time.clock, sleep=time.sleep)


def test_a_server_that_does_not_start_is_a_row_with_its_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watching, "TOWN", "nowhere")
    (row,) = choose(("serve",))[0].measure(Plan(tmp_path, quick=True))
    assert isinstance(row, NotMeasured)
    assert "does not start: Error: Unknown town 'nowhere'" in row.reason


def test_without_the_packages_of_the_page_one_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "websockets.sync.client", None)
    with pytest.raises(MissingPackageError, match="websockets"), watching.watched("nowhere", 1):
        pass
