"""What pages that watch cost the simulator behind `mjdrive serve`: a server of its own, asked from outside how far it got.

The policy that drives by default is asked for a pace that it cannot reach, so every moment that is taken from the simulator
shows. Watchers acknowledge whatever comes, as pages do, and draw nothing: the browser is another machine's.
"""

import contextlib
import json
import socket
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from mjdrive.benchmarks.comparison import Comparison, Plan, Reads, Row
from mjdrive.errors import MissingPackageError, WorkerError

TOWN = "town02"
MOST = 1.10
"""How many times as long a control step may take with pages as without [-]."""

ROUNDS = 8
SECONDS, QUICK_SECONDS = 6.0, 2.0
"""Of one round [s]."""

SETTLING = 1.0
"""Before a round, so that pages have come and gone [s]."""

FASTEST = 8.0
"""The pace that is asked for, simulated over real time [-]."""

PATIENCE = 120.0
"""For the server to start [s]."""


class Progress(NamedTuple):
    """How far a simulator has come.

    Attributes:
        steps: Control steps [-].
        busy: Processor time of its thread [s].
    """

    steps: int
    busy: float


class StepTime(NamedTuple):
    """What a control step takes.

    Attributes:
        wall: By the clock on the wall [s].
        busy: Of the processor [s].
    """

    wall: float
    busy: float


def measure(plan: Plan) -> tuple[Row, ...]:
    """Drive without pages, with one and with eight, in turns.

    Args:
        plan: How much to measure.

    Raises:
        MissingPackageError: If the live page's packages are not installed.
        WorkerError: If the server does not start.
    """
    duration = QUICK_SECONDS if plan.quick else SECONDS
    taken: dict[int, list[StepTime]] = {0: [], 1: [], 8: []}
    with served(plan.workspace) as address:
        with watched(address, 1) as (page,):
            page.send(json.dumps({"op": "speed", "factor": FASTEST}))
            time.sleep(SETTLING)  # only a page that is still there is obeyed
        for number in range(plan.rounds(ROUNDS) + 1):
            for count, rounds in taken.items():
                plan.on_stage(f"{count} pages")
                with watched(address, count):
                    time.sleep(SETTLING)
                    found = step_time(lambda: _progress(address), duration)
                if number:  # the first round warms up
                    rounds.append(found)
    return tuple(
        _row(count, is_wall=is_wall, ours=taken[count], theirs=taken[0])
        for is_wall in (False, True)
        for count in (1, 8)
    )


def step_time(
    progress: Callable[[], Progress],
    duration: float,
    *,
    clock: Callable[[], float] = time.perf_counter,
    sleep: Callable[[float], None] = time.sleep,
) -> StepTime:
    """Time control steps that somebody else takes.

    Args:
        progress: Tells how far they have come.
        duration: How long to watch [s].
        clock: Tells the time [s].
        sleep: Waits so long [s].

    Returns:
        What one takes.

    Raises:
        WorkerError: If there was none.
    """
    first, begin = progress(), clock()
    sleep(duration)
    last, end = progress(), clock()
    steps = last.steps - first.steps
    if not steps:
        raise WorkerError(
            f"The server took no control step in {end - begin:.0f} s; expected some. Close other programs."
        )
    return StepTime((end - begin) / steps, (last.busy - first.busy) / steps)


def _row(count: int, *, is_wall: bool, ours: list[StepTime], theirs: list[StepTime]) -> Comparison:
    if is_wall:
        note = "Wall time, so it counts what pages and server take of the machine besides; only a quiet machine tells it."
    else:
        note = "Processor time of the thread that drives: what it does for pages."
    return Comparison(
        name=f"serving {count}" + (", wall" if is_wall else ""),
        work=f"a control step of `mjdrive serve` in {TOWN}",
        ours="a page watches" if count == 1 else f"{count} pages watch",
        theirs="nobody watches",
        our_rounds=tuple(it.wall if is_wall else it.busy for it in ours),
        their_rounds=tuple(it.wall if is_wall else it.busy for it in theirs),
        bar=MOST,
        reads=Reads.COST,
        piece="control step",
        note=f"{note} The policy that drives by default, as fast as it can; pages take all that is sent.",
    )


def _progress(address: str) -> Progress:
    with urllib.request.urlopen(f"http://{address}/api/health", timeout=PATIENCE) as answer:
        found = json.load(answer)
    return Progress(int(found["steps"]), float(found["busy"]))


@contextlib.contextmanager
def served(folder: Path) -> Iterator[str]:
    """Run `mjdrive serve`; it ends with the context.

    Args:
        folder: Where it runs.

    Yields:
        Host and port.

    Raises:
        WorkerError: If it does not start.
    """
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "mjdrive", "serve", "--town", TOWN, "--port", str(port)]
    with (
        (folder / "serve.log").open("w+", encoding="utf-8") as log,
        subprocess.Popen(command, cwd=folder, stdout=log, stderr=log) as server,
    ):
        try:
            _wait_for(f"127.0.0.1:{port}", server, log)
            yield f"127.0.0.1:{port}"
        finally:
            server.kill()


def _wait_for(address: str, server: "subprocess.Popen[bytes]", log: Any) -> None:
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until and server.poll() is None:
        try:
            _progress(address)
        except OSError:
            time.sleep(0.1)
        else:
            return
    log.seek(0)
    words = log.read()[-500:].strip()
    raise WorkerError(f"`mjdrive serve` does not start: {words} Expected a server at {address}.")


@contextlib.contextmanager
def watched(address: str, count: int) -> Iterator[tuple[Any, ...]]:
    """Let so many pages watch; they go with the context.

    Args:
        address: Host and port of the server.
        count: How many [-].

    Yields:
        Their sockets.

    Raises:
        MissingPackageError: If there is no package for sockets.
    """
    try:
        from websockets.sync.client import connect  # noqa: PLC0415 (an extra)
    except ImportError as error:
        raise MissingPackageError("websockets", wanted_for="this benchmark", extra="web") from error
    with contextlib.ExitStack() as stack:
        pages = tuple(
            stack.enter_context(connect(f"ws://{address}/ws", max_size=None, compression=None))
            for _ in range(count)
        )
        for page in pages:
            threading.Thread(target=_watch, args=(page,), daemon=True).start()
        yield pages


def _watch(page: Any) -> None:
    """Acknowledge every binary message until the connection ends."""
    from websockets.exceptions import ConnectionClosed  # noqa: PLC0415

    count = 0
    with contextlib.suppress(ConnectionClosed):
        for message in page:
            if isinstance(message, bytes):
                count += 1
                page.send(json.dumps({"op": "ack", "n": count}))
