"""What executors do: work that is prepared once a process, and the jobs that it consists of."""

import time
from collections.abc import Callable, Generator, Sequence
from typing import Protocol, TypeVar, runtime_checkable


@runtime_checkable
class Job(Protocol):
    """One thing to do: small, picklable and hashable, with all that decides its result."""

    @property
    def name(self) -> str:
        """Unique among the jobs of a run; what people are told."""


Tell = Callable[[int], None]
"""Told how much of a job is done, in a unit of its own [-]."""

J = TypeVar("J", bound=Job)
R = TypeVar("R")
J_contra = TypeVar("J_contra", bound=Job, contravariant=True)
R_co = TypeVar("R_co", covariant=True)


@runtime_checkable
class Work(Protocol[J_contra, R_co]):
    """What the jobs of a run have in common; it is pickled and sent to whoever works."""

    def begin(self) -> Callable[[J_contra, Tell], R_co]:
        """Prepare once in each process what takes long; the callable then does one job after the other."""


@runtime_checkable
class Executor(Protocol):
    """Gets jobs done somewhere."""

    def run(
        self, work: Work[J, R], jobs: Sequence[J], *, on_progress: Callable[[J, int], None]
    ) -> Generator[tuple[J, R]]:
        """Do every job exactly once, as far as the one who asks can see.

        The one who asks keeps each result as it comes, so that a run which is started again asks only for what is
        missing. Closing the generator ends all that is under way.

        Args:
            work: What the jobs have in common.
            jobs: What to do, in the order of beginning.
            on_progress: Told how far a job is, where that can be known.

        Yields:
            Each job with its result as it is finished, in any order; results do not depend on where they are made.

        Raises:
            MjdriveError: What a job raised.
            WorkerError: If a process or machine that worked was lost, and the job could not be done again.
        """


def seldom(tell: Tell, *, interval: float) -> Tell:
    """Pass on what is told, but not more often than once an interval.

    Args:
        tell: To be told.
        interval: Shortest time between two tellings [s].
    """
    last = -interval

    def tell_seldom(done: int) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= interval:
            last = now
            tell(done)

    return tell_seldom
