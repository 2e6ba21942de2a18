"""The serial executor and the pool: the same results, errors and order of things."""

import os
import signal
import time
from contextlib import closing
from dataclasses import replace

import pytest
from squares import Number, Squares, Stubborn, Threads, expected, numbers

from mjdrive.errors import DataError, WorkerError
from mjdrive.execution import pool
from mjdrive.execution.pool import PoolExecutor, available_cores
from mjdrive.execution.serial import SerialExecutor
from mjdrive.execution.work import Executor

EXECUTORS = [SerialExecutor(), PoolExecutor(2)]


def results(executor: Executor, work: Squares, jobs: list[Number]) -> dict[str, bytes]:
    done = list(executor.run(work, jobs, on_progress=lambda job, steps: None))
    assert len({job for job, _ in done}) == len(done)
    return {job.name: result for job, result in done}


@pytest.mark.parametrize("executor", EXECUTORS)
def test_every_job_is_done_once_and_the_work_begun_once_a_process(
    executor: Executor, squares: Squares
) -> None:
    assert results(executor, squares, numbers(*range(7))) == expected(*range(7))
    assert sorted(value for value, _ in squares.attempts()) == list(range(7))
    assert squares.num_begun() == (1 if executor is EXECUTORS[0] else 2)


def test_a_pool_leaves_this_process_alone_but_for_a_single_job(squares: Squares) -> None:
    pool = PoolExecutor(2)
    results(pool, squares, numbers(1, 2))
    assert os.getpid() not in {pid for _, pid in squares.attempts()}
    results(pool, squares, numbers(3))
    assert (3, os.getpid()) in squares.attempts()
    assert results(pool, squares, []) == {}


@pytest.mark.parametrize("executor", EXECUTORS)
def test_progress_is_told_of_each_job(executor: Executor, squares: Squares) -> None:
    told: set[str] = set()
    slow = replace(squares, seconds=0.5)
    for _ in executor.run(
        slow, numbers(1, 2), on_progress=lambda job, steps: told.add(f"{job.name} {steps}")
    ):
        pass
    for name in ("number-1", "number-2"):
        assert {f"{name} {steps}" for steps in range(1, 6)} & told


@pytest.mark.parametrize("executor", EXECUTORS)
def test_a_users_mistake_comes_back_as_itself(executor: Executor, squares: Squares) -> None:
    with pytest.raises(DataError, match="13 has no square here"):
        results(executor, squares, numbers(1, 13))


def test_a_defect_comes_back_with_its_traceback(squares: Squares) -> None:
    with pytest.raises(RuntimeError, match="raise ZeroDivisionError"):
        results(PoolExecutor(2), squares, numbers(1, 14))


def test_a_process_that_is_killed_at_work_is_told(squares: Squares) -> None:
    slow = replace(squares, seconds=30.0)

    def kill(job: Number, steps: int) -> None:
        (pid,) = {pid for value, pid in slow.attempts() if value == job.value}
        os.kill(pid, signal.SIGKILL)

    with pytest.raises(WorkerError, match=r"worked on 'number-\d' was ended from outside"):
        for _ in PoolExecutor(2).run(slow, numbers(1, 2, 3), on_progress=kill):
            pass


def test_work_that_cannot_be_unpickled_is_told_instead_of_waited_for() -> None:
    with pytest.raises(RuntimeError, match="unpickled elsewhere"):
        results(PoolExecutor(2), Stubborn(), numbers(1, 2))


def test_closing_ends_the_processes(squares: Squares) -> None:
    slow = replace(squares, seconds=1.0)
    with closing(
        PoolExecutor(2).run(slow, numbers(*range(20)), on_progress=lambda job, steps: None)
    ) as run:
        next(run)
    for _, pid in slow.attempts():
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)
    attempts = len(slow.attempts())
    time.sleep(0.5)
    assert len(slow.attempts()) == attempts < 20


def test_processes_share_the_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    shared = results(PoolExecutor(2), Threads(), numbers(1, 2))
    assert set(shared.values()) == {str(max(1, available_cores() // 2))}
    assert "OMP_NUM_THREADS" not in os.environ
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    chosen = results(PoolExecutor(2), Threads(), numbers(1, 2))
    assert set(chosen.values()) == {"3"}


def test_a_process_that_does_not_end_when_told_is_killed(
    squares: Squares, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pool, "END_WITHIN", 0.5)
    slow = replace(squares, seconds=30.0)
    stopped: list[int] = []

    def stop(job: Number, steps: int) -> None:
        """A stopped process hears SIGTERM only when it goes on."""
        (pid,) = {pid for value, pid in slow.attempts() if value == job.value}
        os.kill(pid, signal.SIGSTOP)
        stopped.append(pid)
        raise KeyboardInterrupt

    run = PoolExecutor(2).run(slow, numbers(1, 2), on_progress=stop)
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        next(run)
    assert time.monotonic() - began < 25.0
    for pid in stopped:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)
