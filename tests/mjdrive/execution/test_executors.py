"""Which executor is chosen, and what is refused before anything is done."""

import importlib.util
import socket
import subprocess
import time

import pytest

from mjdrive.errors import ClusterError, ConfigError, MissingPackageError, UnknownNameError
from mjdrive.execution import ray_address
from mjdrive.execution.executors import executor_for
from mjdrive.execution.pool import PoolExecutor, available_cores
from mjdrive.execution.serial import SerialExecutor


def test_one_job_needs_no_process_and_none_given_takes_every_core() -> None:
    assert isinstance(executor_for(), SerialExecutor)
    for jobs, processes in ((3, 3), (None, available_cores())):
        executor = executor_for(jobs=jobs)
        assert isinstance(executor, PoolExecutor)
        assert executor.num_processes == processes


@pytest.mark.parametrize("jobs", [0, -2])
def test_no_jobs_at_once_are_refused(jobs: int) -> None:
    with pytest.raises(ConfigError, match=f"--jobs is {jobs}; expected at least 1, or auto"):
        executor_for(jobs=jobs)


def test_an_unknown_backend_is_refused_with_a_guess() -> None:
    with pytest.raises(UnknownNameError, match=r"backend 'rey'.*Did you mean 'ray'"):
        executor_for(backend="rey")


@pytest.mark.parametrize("backend", ["local", "slurm"])
def test_an_address_without_ray_is_refused(backend: str) -> None:
    with pytest.raises(ConfigError, match=f"no effect with --backend {backend}.*--backend ray"):
        executor_for(backend=backend, address="10.0.0.7:6379")


@pytest.mark.parametrize(("backend", "package"), [("ray", "ray"), ("slurm", "submitit")])
def test_a_missing_package_is_named_with_its_extra(
    backend: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    find = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == package else find(name)
    )
    with pytest.raises(MissingPackageError, match=rf"'{package}'.*--editable \"\.\[{backend}\]\""):
        executor_for(backend=backend)


@pytest.mark.parametrize(
    "address",
    [
        "head",
        "head:",
        "head:port",
        "ray://head:10001",
        ":6379",
        "10.0..7:6379",
        "head:²",
        "head:99999",
    ],
)
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(ClusterError, match="is no HOST:PORT"):
        executor_for(backend="ray", address=address)


def test_a_dead_address_is_refused_within_seconds() -> None:
    with socket.socket() as reserved:
        reserved.bind(("127.0.0.1", 0))
        port = reserved.getsockname()[1]
        began = time.monotonic()
        with pytest.raises(ClusterError, match=rf"Nobody answers at '127\.0\.0\.1:{port}'"):
            executor_for(backend="ray", address=f"127.0.0.1:{port}")
    assert time.monotonic() - began < 2 * ray_address.CONNECT_WITHIN


def test_somebody_who_listens_but_is_no_cluster_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ray_address, "JOIN_WITHIN", 4.0)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(ClusterError, match="did not answer as a Ray cluster within 4 s"):
            executor_for(backend="ray", address=address)


@pytest.mark.parametrize("num_cores", ["0", "0.0", "0.5"])
def test_a_cluster_without_a_core_is_refused(
    num_cores: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    joined = subprocess.CompletedProcess([], 0, stdout=f"whatever Ray says\n{num_cores}\n")
    monkeypatch.setattr(subprocess, "run", lambda *words, **options: joined)
    with pytest.raises(ClusterError, match=r"has no core.*ray start.*joins it"):
        executor_for(backend="ray")
