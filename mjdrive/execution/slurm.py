"""The machines of a Slurm cluster, through submitit: each job is one task of a job array.

Work and results travel through a folder, so this machine and those that work have to see the same file system. Slurm's own
variables (SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT and so on) choose among what a cluster offers.
"""

import pickle
import shutil
import tempfile
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

from mjdrive.errors import ClusterError, WorkerError
from mjdrive.execution.outcomes import Outcome, outcome_of, result_of
from mjdrive.execution.packages import require_package
from mjdrive.execution.work import J, Job, R, Work
from mjdrive.files import write_atomically

FOLDER = Path("slurm")
"""Where work, results and logs of a run lie while it goes on, in the folder where the command was given."""

MINUTES_A_JOB = 120
"""Time that Slurm gives a job, unless SBATCH_TIMELIMIT says otherwise [min]."""

JOBS_AN_ARRAY = 1000
"""Slurm's own limit, unless its administrators changed it, is 1001 [-]."""


class SlurmExecutor:
    """Does the jobs on a Slurm cluster.

    Args:
        num_at_once: Jobs under way at most, or None for as many as there are [-].
        cluster: "slurm"; "local" stands in for it with processes of this machine, for tests.
        folder: Where work, results and logs lie meanwhile; on a file system that all machines see.
        poll: Time between two looks at what is finished [s].

    Raises:
        ClusterError: If this machine cannot submit jobs to Slurm.
        MissingPackageError: If submitit is not installed.
    """

    def __init__(
        self,
        *,
        num_at_once: int | None = None,
        cluster: Literal["slurm", "local"] = "slurm",
        folder: Path = FOLDER,
        poll: float = 2.0,
    ) -> None:
        require_package("submitit", extra="slurm", wanted_for="--backend slurm")
        if cluster == "slurm" and shutil.which("sbatch") is None:
            raise ClusterError(
                "There is no command 'sbatch' here. Expected a machine from which jobs are submitted to Slurm; "
                "log in there, or take --backend local or ray."
            )
        self._num_at_once = num_at_once
        self._cluster = cluster
        self._folder = folder
        self._poll = poll

    def run(
        self, work: Work[J, R], jobs: Sequence[J], *, on_progress: Callable[[J, int], None]
    ) -> Generator[tuple[J, R]]:
        """Do the jobs; see `Executor.run`. Slurm does not tell how far a job is."""
        self._folder.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(prefix="run-", dir=self._folder)).resolve()
        arrays = [
            jobs[start : start + JOBS_AN_ARRAY] for start in range(0, len(jobs), JOBS_AN_ARRAY)
        ]
        # All at once; but Slurm limits what is under way an array, so with a limit one after the other.
        for group in [arrays] if self._num_at_once is None else [[array] for array in arrays]:
            under_way: dict[Any, J] = {}
            try:
                for array in group:
                    under_way |= self._submit(work, array, folder)
                for task, job in self._finished(under_way):
                    yield job, result_of(_fetched(task, job, folder))
            finally:
                for task in under_way:
                    task.cancel(check=False)
        # Logs are of use only where something went wrong.
        shutil.rmtree(folder)
        if not any(self._folder.iterdir()):
            self._folder.rmdir()

    def _submit(self, work: Work[J, R], jobs: Sequence[J], folder: Path) -> dict[Any, J]:
        """Submit an array of jobs that share the file with the work."""
        import cloudpickle  # noqa: PLC0415 - comes with submitit
        import submitit  # noqa: PLC0415 - an extra

        submitter = submitit.AutoExecutor(folder=folder, cluster=self._cluster)
        submitter.update_parameters(
            name="mjdrive",
            cpus_per_task=1,
            timeout_min=MINUTES_A_JOB,
            slurm_array_parallelism=self._num_at_once or JOBS_AN_ARRAY,
        )
        path = folder / "work.pkl"
        write_atomically(path, cloudpickle.dumps(work))
        tasks = submitter.map_array(_attempt, [path] * len(jobs), jobs)
        return dict(zip(tasks, jobs, strict=True))

    def _finished(self, under_way: dict[Any, J]) -> Iterator[tuple[Any, J]]:
        """Look for finished tasks until there are no others; each is taken out."""
        while under_way:
            for task in [task for task in under_way if task.done()]:
                yield task, under_way.pop(task)
            if under_way:
                time.sleep(self._poll)


def _attempt(path: Path, job: Job) -> Outcome[Any]:
    """What a machine of the cluster does with one job."""
    work: Work[Job, Any] = pickle.loads(path.read_bytes())
    return outcome_of(lambda: work.begin()(job, lambda done: None))


def _fetched(task: Any, job: Job, folder: Path) -> Outcome[Any]:
    import submitit  # noqa: PLC0415 - an extra

    errors = (submitit.core.utils.UncompletedJobError, submitit.core.utils.FailedJobError)
    try:
        outcome: Outcome[Any] = task.result()
    except errors as error:
        raise WorkerError(
            f"Slurm's job {task.job_id}, which worked on '{job.name}', ended before it was done. Expected it to finish; "
            f"its log is in '{folder}'. Run the same command again, which goes on from here."
        ) from error
    return outcome
