"""A real Ray cluster of two nodes on this machine: what it collects, and what becomes of a process that is killed there."""

import hashlib
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import psutil
import pytest
from ray.cluster_utils import Cluster

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Route, Town
from mjdrive.episodes import demonstrations
from mjdrive.execution.executors import executor_for
from mjdrive.execution.ray_cluster import RayExecutor
from mjdrive.town import routing

MEGABYTE = 2**20
EPISODES = 4


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Head of a cluster of two nodes of one core; small, as CI has little shared memory."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")  # or Ray warns of its future
        patch.setenv("RAY_OBJECT_STORE_ALLOW_SLOW_STORAGE", "1")
        node = {"num_cpus": 1, "object_store_memory": 80 * MEGABYTE, "include_dashboard": False}
        cluster = Cluster(initialize_head=True, head_node_args=node)
        try:
            cluster.add_node(**node)
            yield cluster.address
        finally:
            cluster.shutdown()


@pytest.fixture
def routes(town02: Town) -> dict[str, Route]:
    rng = np.random.default_rng(4)
    lane, station = routing.random_start(town02, rng)
    route = routing.random_route(town02, lane=lane, station=station, length=80.0, rng=rng)
    return {"short": route}


def digests(folder: Path) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}


def drivers() -> list[psutil.Process]:
    """Processes of the cluster that are driving."""
    return [
        process
        for process in psutil.process_iter(["cmdline"])
        if (process.info["cmdline"] or [""])[0].startswith("ray::_attempt")
    ]


@pytest.mark.slow
def test_killed_process_costs_no_episode_and_changes_no_byte(
    address: str, town02: Town, routes: dict[str, Route], tmp_path: Path
) -> None:
    settings = CollectConfig(episodes=EPISODES)
    demonstrations.collect(town02, routes, tmp_path / "here", settings=settings, seed=0)
    killed: list[int] = []
    finished: list[str] = []
    at_sigterm = signal.getsignal(signal.SIGTERM)

    def report(name: str, done: int, expected: int) -> None:
        assert signal.getsignal(signal.SIGTERM) is at_sigterm
        if done == expected:
            finished.append(name)
        elif not killed:  # it is in the middle of its drive
            (driver, *_) = drivers()
            os.kill(driver.pid, signal.SIGKILL)
            killed.append(driver.pid)

    executor = executor_for(jobs=None, backend="ray", address=address)
    assert isinstance(executor, RayExecutor)
    demonstrations.collect(
        town02,
        routes,
        tmp_path / "cluster",
        settings=settings,
        seed=0,
        executor=executor,
        report=report,
    )
    assert len(killed) == 1
    assert sorted(finished) == [f"short-{index}" for index in range(EPISODES)]
    assert digests(tmp_path / "cluster") == digests(tmp_path / "here")
    assert len(digests(tmp_path / "here")) == EPISODES + 1
