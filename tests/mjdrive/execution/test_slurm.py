"""Slurm through submitit. No Slurm runs here: submitit's own `local` cluster, which differs in how tasks are started, stands in."""

import os
import signal
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import submitit.local.local
from squares import Number, Squares, expected, numbers

from mjdrive.errors import ClusterError, DataError, WorkerError
from mjdrive.execution import slurm
from mjdrive.execution.slurm import SlurmExecutor


@pytest.fixture
def executor(tmp_path: Path) -> Iterator[SlurmExecutor]:
    yield SlurmExecutor(cluster="local", folder=tmp_path / "slurm", poll=0.1)
    for process in list(submitit.local.local._PROCESSES.values()):  # those that were told to end
        process.wait(timeout=60)


def test_every_job_is_done_once_and_nothing_is_left(
    executor: SlurmExecutor, squares: Squares, tmp_path: Path
) -> None:
    done = executor.run(squares, numbers(1, 2, 3), on_progress=lambda job, steps: None)
    assert {job.name: result for job, result in done} == expected(1, 2, 3)
    attempts = squares.attempts()
    assert sorted(value for value, _ in attempts) == [1, 2, 3]
    assert os.getpid() not in {pid for _, pid in attempts}
    assert not (tmp_path / "slurm").exists()


def test_a_users_mistake_comes_back_as_itself(executor: SlurmExecutor, squares: Squares) -> None:
    with pytest.raises(DataError, match="13 has no square here"):
        list(executor.run(squares, numbers(13), on_progress=lambda job, steps: None))


def test_a_job_that_is_killed_is_told_with_its_log(
    executor: SlurmExecutor, squares: Squares, tmp_path: Path
) -> None:
    slow = replace(squares, seconds=60.0)

    def kill() -> None:
        while not slow.attempts():
            time.sleep(0.05)
        os.kill(slow.attempts()[0][1], signal.SIGKILL)

    threading.Thread(target=kill, daemon=True).start()
    with pytest.raises(WorkerError, match=r"worked on 'number-1', ended.*its log is in '(\S+)'"):
        list(executor.run(slow, numbers(1), on_progress=lambda job, steps: None))
    assert list((tmp_path / "slurm").glob("run-*/*log*"))


def noted_arrays(monkeypatch: pytest.MonkeyPatch) -> list[list[int]]:
    """Numbers of each array that is submitted from now on."""
    submit, arrays = SlurmExecutor._submit, []

    def note(self: SlurmExecutor, work: Squares, jobs: list[Number], folder: Path) -> object:
        arrays.append([job.value for job in jobs])
        return submit(self, work, jobs, folder)

    monkeypatch.setattr(SlurmExecutor, "_submit", note)
    return arrays


def test_long_lists_go_in_arrays_that_slurm_takes(
    executor: SlurmExecutor, squares: Squares, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(slurm, "JOBS_AN_ARRAY", 2)
    arrays = noted_arrays(monkeypatch)
    done = executor.run(squares, numbers(1, 2, 3), on_progress=lambda job, steps: None)
    first, _ = next(done)
    assert arrays == [[1, 2], [3]], "no array waits for the slowest job of another"
    assert {first.name} | {job.name for job, _ in done} == set(expected(1, 2, 3))


def test_with_a_limit_arrays_go_one_after_the_other(
    squares: Squares, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(slurm, "JOBS_AN_ARRAY", 1)
    arrays = noted_arrays(monkeypatch)
    limited = SlurmExecutor(num_at_once=1, cluster="local", folder=tmp_path / "slurm", poll=0.1)
    done = limited.run(squares, numbers(1, 2), on_progress=lambda job, steps: None)
    for known in ([[1]], [[1], [2]]):
        next(done)
        assert arrays == known
    assert list(done) == []


def test_a_machine_without_sbatch_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(ClusterError, match="no command 'sbatch' here"):
        SlurmExecutor()
