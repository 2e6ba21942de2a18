"""Work that is easy to look through, for every executor."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from mjdrive.errors import DataError
from mjdrive.execution.work import Tell

STEPS = 5
"""Steps of a job [-]."""


@dataclass(frozen=True)
class Number:
    """A job."""

    value: int

    @property
    def name(self) -> str:
        return f"number-{self.value}"


@dataclass(frozen=True)
class Squares:
    """Squares numbers, refuses 13, fails at 14, and notes in a folder which process began and which attempted what."""

    folder: Path
    seconds: float = 0.0

    def begin(self) -> Callable[[Number, Tell], bytes]:
        (self.folder / f"begun-{os.getpid()}-{time.monotonic_ns()}").touch()
        return self.square

    def square(self, job: Number, tell: Tell) -> bytes:
        (self.folder / f"attempt-{job.value}-{os.getpid()}-{time.monotonic_ns()}").touch()
        for step in range(STEPS):
            time.sleep(self.seconds / STEPS)
            tell(step + 1)
        if job.value == 13:
            raise DataError("13 has no square here. Expected another number.")
        if job.value == 14:
            raise ZeroDivisionError
        return str(job.value**2).encode() * 50_000

    def attempts(self) -> list[tuple[int, int]]:
        """Number and process of each attempt so far."""
        found = (path.name.split("-") for path in self.folder.glob("attempt-*"))
        return [(int(value), int(pid)) for _, value, pid, _ in found]

    def num_begun(self) -> int:
        """Times that the work was begun."""
        return len(list(self.folder.glob("begun-*")))


def numbers(*values: int) -> list[Number]:
    return [Number(value) for value in values]


def expected(*values: int) -> dict[str, bytes]:
    """Results by the names of their jobs."""
    return {Number(value).name: str(value**2).encode() * 50_000 for value in values}


class Stubborn:
    """Work that can be sent but not received."""

    def __reduce__(self) -> tuple[object, ...]:
        return _refuse, ()

    def begin(self) -> Callable[[Number, Tell], bytes]:
        raise AssertionError("never begun")


def _refuse() -> None:
    raise ValueError("this is not unpickled elsewhere")


class Threads:
    """Tells how many threads numpy and torch would take."""

    def begin(self) -> Callable[[Number, Tell], str]:
        return lambda job, tell: os.environ["OMP_NUM_THREADS"]
