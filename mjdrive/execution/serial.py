"""One job after the other, in this process."""

from collections.abc import Callable, Generator, Sequence
from functools import partial

from mjdrive.execution.work import J, R, Work


class SerialExecutor:
    """Does the jobs here."""

    def run(
        self, work: Work[J, R], jobs: Sequence[J], *, on_progress: Callable[[J, int], None]
    ) -> Generator[tuple[J, R]]:
        """Do the jobs in their order; see `Executor.run`."""
        do = work.begin()
        for job in jobs:
            yield job, do(job, partial(on_progress, job))
