"""Slurm through submitit. No Slurm runs here: submitit's own `local` cluster, which differs in how tasks are started, stands in."""

import os
import signal
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest
from squares import Squares, expected, numbers

from mjdrive.errors import ClusterError, DataError, WorkerError
from mjdrive.execution import slurm
from mjdrive.execution.slurm import SlurmExecutor


@pytest.fixture
def executor(tmp_path: Path) -> SlurmExecutor:
    return SlurmExecutor(cluster="local", folder=tmp_path / "slurm", poll=0.1)


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


def test_long_lists_go_in_arrays_that_slurm_takes(
    executor: SlurmExecutor, squares: Squares, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(slurm, "JOBS_AN_ARRAY", 2)
    done = executor.run(squares, numbers(1, 2, 3), on_progress=lambda job, steps: None)
    assert {job.name: result for job, result in done} == expected(1, 2, 3)


def test_a_machine_without_sbatch_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(ClusterError, match="no command 'sbatch' here"):
        SlurmExecutor()
