"""Do the jobs of a stage that are left, and tell how far each is."""

from collections.abc import Callable, Sequence
from contextlib import closing
from typing import TypeVar

from mjdrive.execution.work import Executor, Job, Work

Report = Callable[[str, int, int], None]
"""Told the name of something that is worked on, how much of it is done, and how much there is; at the end both are equal."""

J = TypeVar("J", bound=Job)
R = TypeVar("R")


def do_all(
    work: Work[J, R],
    jobs: Sequence[J],
    *,
    size: Callable[[J], int],
    is_done: Callable[[J], bool],
    keep: Callable[[J, R], None],
    executor: Executor,
    report: Report,
) -> None:
    """Do every job that is not done, and keep what comes of it at once.

    Args:
        work: What the jobs have in common.
        jobs: Largest first, so that nobody is left with a large one when the others are done.
        size: How much there is to do in a job, in the unit in which it tells its progress [-].
        is_done: Whether a job was done earlier.
        keep: Writes what came of a job.
        executor: Where the work is done; what is kept does not depend on it.
        report: Told how far each job is.

    Raises:
        MjdriveError: What a job raised.
        WorkerError: If a process or machine that worked was lost.
    """

    def on_progress(job: J, done: int) -> None:
        report(job.name, min(done, size(job) - 1), size(job))

    missing = []
    for job in jobs:
        if is_done(job):
            report(job.name, size(job), size(job))
        else:
            missing.append(job)
    if not missing:
        return
    with closing(executor.run(work, missing, on_progress=on_progress)) as results:
        for job, result in results:
            keep(job, result)
            report(job.name, size(job), size(job))
