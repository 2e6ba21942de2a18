"""The machines of a Ray cluster.

Ray keeps one process a core, sends it one job after the other and does a job again elsewhere if its process or machine is
lost. A job has no effect but its result, so doing it twice is doing it once.
"""

import contextlib
import logging
import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from functools import lru_cache
from typing import Any

from mjdrive.errors import WorkerError
from mjdrive.execution.outcomes import Outcome, outcome_of, result_of
from mjdrive.execution.packages import require_package
from mjdrive.execution.patience import Patience
from mjdrive.execution.ray_address import require_cluster
from mjdrive.execution.work import J, Job, R, Work, seldom

RETRIES = 5
"""Times that a job is done again because its process or machine was lost [-]."""

BETWEEN_REPORTS = 1.0
"""Least time between two reports of a process [s]."""

_WAIT = 0.2
"""Time between two looks for results and for progress [s]."""

_ANSWER = 0.5
"""Time to wait for what is known of progress [s]."""


class RayExecutor:
    """Does the jobs on a cluster that runs already; this machine has to be part of it.

    Args:
        address: HOST:PORT of its head, or None for the cluster that this machine is part of.
        num_at_once: Jobs under way at most, or None for two a core of the cluster, so that none waits for the next [-].

    Raises:
        ClusterError: If no cluster answers there.
        MissingPackageError: If Ray is not installed.
    """

    def __init__(self, *, address: str | None = None, num_at_once: int | None = None) -> None:
        require_package("ray", extra="ray", wanted_for="--backend ray")
        self._address = address or "auto"
        self._num_at_once = num_at_once
        require_cluster(self._address)

    def run(
        self, work: Work[J, R], jobs: Sequence[J], *, on_progress: Callable[[J, int], None]
    ) -> Generator[tuple[J, R]]:
        """Do the jobs; see `Executor.run`.

        Raises:
            ClusterError: If the cluster loses all its cores.
        """
        with _connection(self._address) as ray:
            attempt = ray.remote(num_cpus=1, max_retries=RETRIES)(_attempt)
            progress = ray.remote(num_cpus=0, max_restarts=-1)(_Progress).remote()
            # In a list, so that Ray hands on the reference: each process fetches the work once, not with every job.
            shared = [ray.put(work)]
            waiting = deque(jobs)
            under_way: dict[Any, J] = {}
            patience = Patience()
            try:
                while waiting or under_way:
                    num_cores = ray.cluster_resources().get("CPU", 0.0)
                    while waiting and len(under_way) < self._room(num_cores):
                        job = waiting.popleft()
                        under_way[attempt.remote(shared, job, progress)] = job
                    ready, _ = ray.wait(list(under_way), timeout=0.0)
                    if not ready:
                        # Not in `ray.wait`, which makes exit status 1 of any signal that ends it.
                        time.sleep(_WAIT)
                    jobs_by_name = {job.name: job for job in under_way.values()}
                    if _tell(ray, progress, jobs_by_name, on_progress) or ready:
                        patience.hear()
                    patience.wait(num_cores)
                    for reference in ready:
                        job = under_way.pop(reference)
                        yield job, result_of(_fetched(ray, reference, job))
            finally:
                for reference in under_way:
                    ray.cancel(reference, force=True)

    def _room(self, num_cores: float) -> int:
        return self._num_at_once or max(1, 2 * int(num_cores))


class _Progress:
    """Lives in a process of the cluster and remembers how far jobs are."""

    def __init__(self) -> None:
        self._done: dict[str, int] = {}

    def tell(self, name: str, done: int) -> None:
        self._done[name] = done

    def take(self) -> dict[str, int]:
        """What was told since the last time."""
        done, self._done = self._done, {}
        return done


@lru_cache(maxsize=1)
def _begun(reference: Any) -> Callable[[Job, Callable[[int], None]], Any]:
    """Prepare the work of a run; kept by the process for the next job."""
    import ray  # noqa: PLC0415 - an extra

    work: Work[Job, Any] = ray.get(reference)
    return work.begin()


def _attempt(shared: list[Any], job: Job, progress: Any) -> Outcome[Any]:
    """What a process of the cluster does with one job."""

    def tell(done: int) -> None:
        progress.tell.remote(job.name, done)

    report = seldom(tell, interval=BETWEEN_REPORTS)
    return outcome_of(lambda: _begun(shared[0])(job, report))


def _tell(
    ray: Any, progress: Any, jobs: dict[str, J], on_progress: Callable[[J, int], None]
) -> bool:
    """Pass on what is known, if anything; the process that knows it may be lost as any other, and begins again."""
    try:
        told: dict[str, int] = ray.get(progress.take.remote(), timeout=_ANSWER)
    except ray.exceptions.RayError:
        return False
    for name, done in told.items():
        if name in jobs:
            on_progress(jobs[name], done)
    return bool(told)


def _fetched(ray: Any, reference: Any, job: Job) -> Outcome[Any]:
    try:
        outcome: Outcome[Any] = ray.get(reference)
    except ray.exceptions.RayError as error:
        reason = str(error).strip().splitlines()[-1].strip().rstrip(".")
        raise WorkerError(
            f"The Ray cluster could not finish '{job.name}': {reason} ({type(error).__name__}). Expected machines with "
            f"this version of mjdrive and enough memory. Mend that and run the same command again, which goes on from here."
        ) from error
    return outcome


@contextlib.contextmanager
def _connection(address: str) -> Iterator[Any]:
    """Ray, connected to the cluster; a connection that somebody made before is left as it is."""
    import ray  # noqa: PLC0415 - an extra

    if ray.is_initialized():
        yield ray
        return
    with _own_sigterm():
        ray.init(address=address, logging_level=logging.ERROR, log_to_driver=False)
    try:
        yield ray
    finally:
        ray.shutdown()


@contextlib.contextmanager
def _own_sigterm() -> Iterator[None]:
    """Keep what this process does at SIGTERM; Ray would put in its own way, with a trace of its own stack."""
    before = signal.getsignal(signal.SIGTERM)
    yield
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, before)
