"""Drives the episodes of a collection in several processes.

Each process is started afresh (no fork: MuJoCo may hold OpenGL and threads), builds its own simulation and drives what it is
given. Files are written by the process that asked for them, and by it alone, so Ctrl-C leaves whole files.
"""

import multiprocessing
import signal
import threading
import traceback
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess

from mjdrive.episodes.collector import Collector, Driven, Job
from mjdrive.episodes.plan import PlannedEpisode
from mjdrive.errors import MjdriveError, WorkerError

STEPS_BETWEEN_REPORTS = 20
"""How often a process says how far it is [-]."""


def drive_in_processes(
    job: Job,
    episodes: Sequence[PlannedEpisode],
    *,
    num_processes: int,
    on_step: Callable[[PlannedEpisode, int], None],
) -> Generator[Driven]:
    """Drive episodes in several processes at once.

    Args:
        job: What the processes have to know.
        episodes: What to drive.
        num_processes: How many processes drive.
        on_step: Told an episode that is being driven, and the number of its control steps done.

    Yields:
        Each episode as it is finished, in any order; their bytes do not depend on the number of processes.

    Raises:
        MjdriveError: What one of the processes raised.
        WorkerError: If a process ended before it was done.
    """
    waiting = deque(episodes)
    driving: dict[Connection, PlannedEpisode] = {}
    processes: list[SpawnProcess] = []
    try:
        with _no_interrupts():
            for _ in range(min(num_processes, len(waiting))):
                process, connection = _start(job)
                processes.append(process)
                driving[connection] = _hand_out(waiting, connection)
        while driving:
            ready = wait(list(driving))
            for connection in [one for one in driving if one in ready]:
                message = _receive(connection, driving[connection])
                if isinstance(message, int):
                    on_step(driving[connection], message)
                    continue
                if isinstance(message, MjdriveError):
                    raise message
                assert not isinstance(message, str), f"a process that drives failed:\n{message}"
                del driving[connection]
                if waiting:
                    driving[connection] = _hand_out(waiting, connection)
                yield message
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            process.join()


def _start(job: Job) -> tuple[SpawnProcess, Connection]:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_work, args=(job, theirs), daemon=True)
    process.start()
    theirs.close()  # so that the end of the process is the end of the connection
    return process, ours


def _hand_out(waiting: deque[PlannedEpisode], connection: Connection) -> PlannedEpisode:
    episode = waiting.popleft()
    try:
        connection.send(episode)
    except (BrokenPipeError, ConnectionResetError) as error:
        raise _ended(episode) from error
    return episode


def _receive(connection: Connection, episode: PlannedEpisode) -> int | Driven | MjdriveError | str:
    try:
        return connection.recv()
    except (EOFError, ConnectionResetError) as error:
        raise _ended(episode) from error


def _ended(episode: PlannedEpisode) -> WorkerError:
    return WorkerError(
        f"The process that drove '{episode.name}' was ended from outside, perhaps for want of memory. Expected it to "
        f"finish. Run the same command again, which goes on from here, with fewer --jobs."
    )


def _work(job: Job, connection: Connection) -> None:
    """What a process does: drive what comes, until nobody is there to send any more."""
    try:
        collector = Collector(job)
        while True:
            episode: PlannedEpisode = connection.recv()
            connection.send(collector.drive(episode, _reporter(connection)))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return  # whoever asked is gone
    except MjdriveError as error:
        connection.send(error)
    except Exception:
        connection.send(traceback.format_exc())
        raise


def _reporter(connection: Connection) -> Callable[[int], None]:
    def report(done: int) -> None:
        if done % STEPS_BETWEEN_REPORTS == 0:
            connection.send(done)

    return report


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
