"""A process behind `serving.py`, told to step and asked how long that took."""

import contextlib
import importlib.resources
import json
import os
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, cast

from mjdrive.errors import WorkerError

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
_INSTALL = "run scripts/bench/install_rivals.py again."
_NO_SCREEN = {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}


@dataclass(frozen=True, slots=True)
class Served:
    """A world in a process of its own.

    Attributes:
        name: How messages call it.
        facts: What it says of itself: versions, shape of the observation.
    """

    name: str
    facts: dict[str, Any]
    _process: "subprocess.Popen[str]"
    _complaints: IO[str]

    def steps(self, count: int) -> float:
        """Let it do some control steps and tell what they took of the processor [s].

        Raises:
            WorkerError: If the process has ended.
        """
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # `_answer` says why
            self._process.stdin.write(json.dumps({"steps": count}) + "\n")
            self._process.stdin.flush()
        return float(_answer(self._process, self._complaints, self.name)["cpu"])


@contextlib.contextmanager
def serve(name: str, python: Path, world: Path, argument: str, *, log: Path) -> Iterator[Served]:
    """Start a world in a process of its own, on one core; it ends with the context.

    Args:
        name: How messages call it.
        python: Interpreter of its environment.
        world: File with its `make`.
        argument: What `make` is given.
        log: File for what it says on stderr.

    Yields:
        The world, ready to step.

    Raises:
        WorkerError: If it does not start.
    """
    server = Path(str(importlib.resources.files("mjdrive.benchmarks") / "serving.py"))
    # -P: the folder of `serving.py` must not hide modules of the rivals.
    command = [str(python), "-P", str(server), str(world), argument]
    with (
        log.open("w+", encoding="utf-8") as complaints,
        _started(command, name, complaints) as process,
    ):
        try:
            yield Served(name, _answer(process, complaints, name), process, complaints)
        finally:
            process.kill()


def _started(command: list[str], name: str, complaints: IO[str]) -> "subprocess.Popen[str]":
    try:
        return subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=complaints,
            text=True,
            env={**os.environ, **_ONE_THREAD, **_NO_SCREEN},
        )
    except OSError as error:  # the interpreter that an environment was made with may be gone
        raise WorkerError(
            f"The process of {name} does not start ({error}). Expected a Python that runs; {_INSTALL}"
        ) from error


def _answer(process: "subprocess.Popen[str]", complaints: IO[str], name: str) -> dict[str, Any]:
    """Read one line of JSON from a process."""
    assert process.stdout is not None
    line = process.stdout.readline()
    if not line:
        complaints.seek(0)
        last = complaints.read().strip().rpartition("\n")[2]
        raise WorkerError(f"The process of {name} ended ({last}). Expected it to step; {_INSTALL}")
    try:
        return cast("dict[str, Any]", json.loads(line))
    except ValueError as error:
        raise WorkerError(
            f"The process of {name} said '{line.strip()}'. Expected a line of JSON; {_INSTALL}"
        ) from error
