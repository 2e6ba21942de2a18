"""A real Ray cluster of two nodes on this machine: what it collects, and what becomes of a process that is killed there."""

import contextlib
import hashlib
import os
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest
import ray

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Route, Town
from mjdrive.episodes import demonstrations
from mjdrive.execution.executors import executor_for
from mjdrive.execution.ray_cluster import RayExecutor
from mjdrive.execution.work import Executor, Tell, Work
from mjdrive.town import routing

EPISODES = 4
BETWEEN_KILLS = 10.0
"""Time for a job to begin anew [s]."""


@pytest.fixture
def routes(town02: Town) -> dict[str, Route]:
    rng = np.random.default_rng(4)
    lane, station = routing.random_start(town02, rng)
    route = routing.random_route(town02, lane=lane, station=station, length=200.0, rng=rng)
    return {"short": route}


def digests(folder: Path) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}


@dataclass(frozen=True)
class Noting:
    """Work that notes each attempt of a job, and by which process, before it is done."""

    work: Work[Any, Any]
    folder: Path

    def begin(self) -> Callable[[Any, Tell], Any]:
        do = self.work.begin()

        def attempt(job: Any, tell: Tell) -> Any:
            (self.folder / f"{job.name}.{os.getpid()}.{time.monotonic_ns()}").touch()
            return do(job, tell)

        return attempt


@dataclass
class NotingExecutor:
    """Does jobs as another executor does, and knows of each attempt."""

    executor: Executor
    folder: Path

    def run(self, work: Any, jobs: Any, *, on_progress: Any) -> Any:
        return self.executor.run(Noting(work, self.folder), jobs, on_progress=on_progress)

    def attempts(self) -> list[tuple[str, int]]:
        """Job and process of each attempt so far."""
        notes = [path.name.split(".") for path in self.folder.iterdir()]
        return [(name, int(pid)) for name, pid, _ in notes]

    def done_again(self) -> list[str]:
        """Jobs that were attempted more than once."""
        names = Counter(name for name, _ in self.attempts())
        return [name for name, count in names.items() if count > 1]


@pytest.fixture
def sent_by_value() -> Iterator[None]:
    """Classes of this file can be imported nowhere else."""
    module = sys.modules[__name__]
    ray.cloudpickle.register_pickle_by_value(module)
    yield
    ray.cloudpickle.unregister_pickle_by_value(module)


def kill_a_driver(executor: NotingExecutor) -> bool:
    """Kill a process that is driving; false if none is at this moment."""
    noted = {pid for _, pid in executor.attempts()}
    for process in psutil.process_iter(["cmdline"]):
        is_driving = (process.info["cmdline"] or [""])[0].startswith("ray::_attempt")
        if is_driving and process.pid in noted:
            with contextlib.suppress(psutil.NoSuchProcess):
                process.kill()
                return True
    return False


@pytest.mark.slow
@pytest.mark.usefixtures("sent_by_value")
def test_killed_process_costs_no_episode_and_changes_no_byte(
    ray_address: str, town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    settings = CollectConfig(episodes=EPISODES)
    demonstrations.collect(town02, routes, tmp_path / "here", settings=settings, seed=0)
    finished: list[str] = []
    kill_again_at = 0.0
    at_sigterm = signal.getsignal(signal.SIGTERM)
    ray_executor = executor_for(jobs=None, backend="ray", address=ray_address)
    assert isinstance(ray_executor, RayExecutor)
    (tmp_path / "attempts").mkdir()
    executor = NotingExecutor(ray_executor, tmp_path / "attempts")

    def report(name: str, done: int, expected: int) -> None:
        nonlocal kill_again_at
        assert signal.getsignal(signal.SIGTERM) is at_sigterm
        if done == expected:
            finished.append(name)
        elif executor.done_again() or time.monotonic() < kill_again_at:
            pass
        elif kill_a_driver(executor):
            # One that is killed between two episodes proves nothing; then another follows.
            kill_again_at = time.monotonic() + BETWEEN_KILLS

    demonstrations.collect(
        town02,
        routes,
        tmp_path / "cluster",
        settings=settings,
        seed=0,
        executor=executor,
        report=report,
    )
    assert executor.done_again(), "no episode was cut short and driven again"
    assert {name for name, _ in executor.attempts()} == set(finished)
    assert sorted(finished) == [f"short-{index}" for index in range(EPISODES)]
    assert digests(tmp_path / "cluster") == digests(tmp_path / "here")
    assert len(digests(tmp_path / "here")) == EPISODES + 1
