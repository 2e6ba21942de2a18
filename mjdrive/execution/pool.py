"""Several processes on this machine.

Each process is started afresh (no fork: MuJoCo may hold OpenGL and threads), prepares the work once and does what it is
given. Nothing but the result of a whole job comes back, so Ctrl-C leaves whole files.
"""

import multiprocessing
import os
import pickle
import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any

from mjdrive.errors import WorkerError
from mjdrive.execution.outcomes import Done, Outcome, outcome_of, result_of
from mjdrive.execution.serial import SerialExecutor
from mjdrive.execution.work import J, Job, R, Tell, Work, seldom

BETWEEN_REPORTS = 0.1
"""Least time between two reports of a process [s]."""

END_WITHIN = 5.0
"""Time for all processes to end when they are told to; then they are killed [s]."""

THREADS = "OMP_NUM_THREADS"
"""Says to numpy and torch how many threads they may have."""


class PoolExecutor:
    """Does the jobs in processes of this machine.

    Args:
        num_processes: How many at once [-].
    """

    def __init__(self, num_processes: int) -> None:
        self.num_processes = num_processes

    def run(
        self, work: Work[J, R], jobs: Sequence[J], *, on_progress: Callable[[J, int], None]
    ) -> Generator[tuple[J, R]]:
        """Do the jobs; see `Executor.run`. A single one is done here, which saves a process."""
        num_processes = min(self.num_processes, len(jobs))
        if num_processes <= 1:
            yield from SerialExecutor().run(work, jobs, on_progress=on_progress)
            return
        waiting = deque(jobs)
        under_way: dict[Connection, J] = {}
        processes: list[SpawnProcess] = []
        connections: list[Connection] = []
        try:
            with _no_interrupts(), _threads_shared_by(num_processes):
                connections.extend(_start(processes) for _ in range(num_processes))
            # Plainly: multiprocessing's own way shares the memory of tensors, which needs both processes alive.
            content = pickle.dumps(work)
            for connection in connections:
                under_way[connection] = _hand_out(waiting, connection, content)
            while under_way:
                for connection in _ready(under_way):
                    job = under_way[connection]
                    message = _receive(connection, job)
                    if isinstance(message, int):
                        on_progress(job, message)
                        continue
                    result = result_of(message)
                    del under_way[connection]
                    if waiting:
                        under_way[connection] = _hand_out(waiting, connection)
                    yield job, result
        finally:
            _end(processes, connections)


def _start(processes: list[SpawnProcess]) -> Connection:
    """Start a process and note it at once, so that it is ended whatever comes next."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    # The work follows through the pipe: `start` itself waits for ever if a process ends while it reads its arguments.
    process = context.Process(target=_serve, args=(theirs,), daemon=True)
    process.start()
    processes.append(process)
    theirs.close()  # so that the end of the process is the end of the connection
    return ours


def _end(processes: Sequence[SpawnProcess], connections: Sequence[Connection]) -> None:
    """End processes whatever they do; one that is stopped, or deep in the system, hears of nothing but the last word."""
    for process in processes:
        process.terminate()
    for connection in connections:
        connection.close()
    ending_by = time.monotonic() + END_WITHIN
    for process in processes:
        process.join(max(0.0, ending_by - time.monotonic()))
        if process.is_alive():
            process.kill()
            process.join()


def _ready(under_way: dict[Connection, J]) -> list[Connection]:
    ready = wait(list(under_way))
    return [connection for connection in under_way if connection in ready]


def _hand_out(waiting: deque[J], connection: Connection, work: bytes | None = None) -> J:
    """Give a process its next job, after the work if it is new."""
    job = waiting.popleft()
    try:
        if work is not None:
            connection.send_bytes(work)
        connection.send(job)
    except (BrokenPipeError, ConnectionResetError) as error:
        raise _ended(job) from error
    return job


def _receive(connection: Connection, job: Job) -> int | Outcome[Any]:
    """A bare number is progress; results come wrapped."""
    try:
        message: int | Outcome[Any] = connection.recv()
    except (EOFError, ConnectionResetError) as error:
        raise _ended(job) from error
    return message


def _ended(job: Job) -> WorkerError:
    return WorkerError(
        f"The process that worked on '{job.name}' was ended from outside, perhaps for want of memory. Expected it to "
        f"finish. Run the same command again, which goes on from here, with fewer --jobs."
    )


def _serve(connection: Connection) -> None:
    """What a process does: work on what comes, until nobody is there to send any more."""
    try:
        content = connection.recv_bytes()
        begun = outcome_of(lambda: _begin(content))
        if not isinstance(begun, Done):
            connection.send(begun)
            return
        report = seldom(connection.send, interval=BETWEEN_REPORTS)
        while True:
            job: Job = connection.recv()
            connection.send(outcome_of(partial(begun.result, job, report)))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return  # whoever asked is gone


def _begin(content: bytes) -> Callable[[Job, Tell], Any]:
    work: Work[Job, Any] = pickle.loads(content)
    return work.begin()


@contextmanager
def _no_interrupts() -> Iterator[None]:
    """Let processes that are started here leave Ctrl-C to whoever started them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _threads_shared_by(num_processes: int) -> Iterator[None]:
    """Let processes that are started here share the cores; each on all of them would slow all down."""
    before = os.environ.get(THREADS)
    if before is None:
        os.environ[THREADS] = str(max(1, available_cores() // num_processes))
    try:
        yield
    finally:
        if before is None:
            del os.environ[THREADS]


def available_cores() -> int:
    """Cores that this process may use [-]."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
