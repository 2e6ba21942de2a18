"""Which executor a user asks for."""

from typing import Literal, get_args

from mjdrive.errors import ConfigError, UnknownNameError
from mjdrive.execution.pool import PoolExecutor, available_cores
from mjdrive.execution.ray_cluster import RayExecutor
from mjdrive.execution.serial import SerialExecutor
from mjdrive.execution.slurm import SlurmExecutor
from mjdrive.execution.work import Executor

Backend = Literal["local", "ray", "slurm"]
"""Where jobs are done."""

BACKENDS: tuple[str, ...] = get_args(Backend)


def executor_for(
    *, jobs: int | None = 1, backend: str = "local", address: str | None = None
) -> Executor:
    """Make an executor; what can be wrong with a cluster is found here, before anything is done.

    Args:
        jobs: Jobs at once, or None for as many as this machine has cores, or as the cluster takes [-].
        backend: "local", "ray" or "slurm".
        address: HOST:PORT of the head of a Ray cluster, or None for the one that this machine is part of.

    Raises:
        ClusterError: If there is no such cluster.
        ConfigError: If the number is not positive, or an address has no effect.
        MissingPackageError: If the package for a cluster is not installed.
        UnknownNameError: If there is no such backend.
    """
    if backend not in BACKENDS:
        raise UnknownNameError("backend", backend, BACKENDS)
    if jobs is not None and jobs < 1:
        raise ConfigError(f"--jobs is {jobs}; expected at least 1, or auto.")
    if address is not None and backend != "ray":
        raise ConfigError(
            f"--address {address} has no effect with --backend {backend}. Leave it out, or take --backend ray."
        )
    if backend == "ray":
        return RayExecutor(address=address, num_at_once=jobs)
    if backend == "slurm":
        return SlurmExecutor(num_at_once=jobs)
    if jobs == 1:
        return SerialExecutor()
    return PoolExecutor(jobs or available_cores())
