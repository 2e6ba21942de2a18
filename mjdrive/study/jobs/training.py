"""Train the agents of a study, each in a run folder of its own that can be gone on with.

On a cluster whose machines see that folder and the data, agents are trained there; else here, as a run is not sent home
before it is complete, and hours would be lost with whoever trains.
"""

import dataclasses
import logging
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import torch

from mjdrive import versions
from mjdrive.config import StudyConfig
from mjdrive.execution.pool import PoolExecutor, available_cores
from mjdrive.execution.serial import SerialExecutor
from mjdrive.execution.work import Executor, Tell
from mjdrive.learning import runs
from mjdrive.learning.training import train
from mjdrive.study.jobs.checkpoints import keep_epoch
from mjdrive.study.jobs.shared_folders import SharedFolders, marked, why_not_there
from mjdrive.study.jobs.sharing import Report, do_all
from mjdrive.study.settings.agents import Agent, learner_config
from models.config import LearnerConfig
from models.energy_scoring import resolved
from models.hardware import choose_device
from models.progress import StepReport


@dataclass(frozen=True, slots=True)
class TrainingJob:
    """One run to train, or to go on with.

    Attributes:
        name: Of the agent.
        config: Its settings.
        seed: Training seed [-].
        data: Folder of the demonstrations.
        run: Run folder.
        keep_every: Epochs between two checkpoints that are kept; 0 keeps none [-].
        num_steps: Steps of the whole run [-].
        threads: That torch may use; the weights depend on it [-].
        device: Kind of device that trains, "cpu" or "cuda"; the weights depend on it, too.
    """

    name: str
    config: LearnerConfig
    seed: int
    data: Path
    run: Path
    keep_every: int
    num_steps: int
    threads: int
    device: str


@dataclass(frozen=True, slots=True)
class Training:
    """Trains runs, one after the other, each with the threads that the study has for it, however many train beside it.

    Attributes:
        versions: Of the software where training was asked for.
        folders: What has to be seen to train.
    """

    versions: dict[str, str]
    folders: SharedFolders

    def begin(self) -> Callable[[TrainingJob, Tell], None]:
        """Make sure of versions and folders; what comes back trains one run.

        Raises:
            WorkerError: If this is a machine with other versions, or does not see the folders.
        """
        versions.require_same(self.versions)
        self.folders.require_seen()
        return _train


def training_job(
    agent: Agent, data: Path, run: Path, *, config: StudyConfig, num_samples: int
) -> TrainingJob:
    """What is to be done to train an agent, in the number format that this machine is fast at.

    Args:
        agent: Whose run.
        data: Folder of the demonstrations.
        run: Run folder.
        config: Settings of the study.
        num_samples: Demonstrations [-].
    """
    settings = learner_config(agent.variant)
    device = choose_device()
    precision = resolved(settings.optimiser.precision, device)
    optimiser = dataclasses.replace(settings.optimiser, precision=precision)
    num_training = num_samples - math.floor(optimiser.validation_share * num_samples)
    return TrainingJob(
        name=agent.name,
        config=dataclasses.replace(settings, optimiser=optimiser),
        seed=agent.seed,
        data=data.absolute(),
        run=run.absolute(),
        keep_every=0 if agent.variant.change else config.progress_every,
        num_steps=optimiser.epochs * optimiser.steps_per_epoch(num_training),
        threads=config.threads,
        device=device.type,
    )


def train_all(jobs: Sequence[TrainingJob], *, executor: Executor, report: Report) -> None:
    """Train every run.

    Args:
        jobs: What to train; all with run folders beside each other, and with the same threads and device.
        executor: Where, if those who work for it can; the weights do not depend on how many train at once.
        report: Told the name of a run, its steps so far and its steps in all.

    Raises:
        DataError: If the demonstrations are missing, unfinished or damaged.
        RunError: If a run folder holds a run with other settings, or training fails.
        WorkerError: If a process or machine that trained was lost, has other versions or does not see what others see.
    """
    if not jobs:
        return
    with marked(jobs[0].run.parent, {job.data for job in jobs}) as folders:
        do_all(
            Training(versions.all_versions(), folders),
            jobs,
            size=lambda job: job.num_steps,
            is_done=lambda job: False,  # a run that is whole is checked, and goes on with nothing
            keep=lambda job, _: None,  # its folder is all there is of it
            executor=_place(jobs[0], folders, executor),
            report=report,
        )


def _place(job: TrainingJob, folders: SharedFolders, executor: Executor) -> Executor:
    """Where agents can be trained: where they were meant to be, or else here, which is said."""
    obstacle = why_not_there(folders, job.device, versions.all_versions(), executor)
    if obstacle is None:
        return executor
    # On a GPU one after the other, as several share its memory.
    at_once = 1 if job.device != "cpu" else max(1, available_cores() // job.threads)
    logging.getLogger(__name__).warning(
        "Agents are trained here, %d at once: %s. The cluster trains them where it sees the folders of --out and --data "
        "and has such a device; all else goes to the cluster.",
        at_once,
        obstacle,
    )
    return SerialExecutor() if at_once == 1 else PoolExecutor(at_once)


def _train(job: TrainingJob, tell: Tell) -> None:
    resumes = runs.is_run(job.run)
    is_begun = False

    def on_step(step: StepReport) -> None:
        nonlocal is_begun
        if resumes and not is_begun:  # the interruption may have come between checkpoint and copy
            keep_epoch(job.run, every=job.keep_every)
        is_begun = True
        tell(step.step)

    with _threads(job.threads):
        train(
            job.config,
            data=job.data,
            run=job.run,
            seed=job.seed,
            resume=resumes,
            device=job.device,
            on_step=on_step,
            on_epoch=lambda _: keep_epoch(job.run, every=job.keep_every),
        )


@contextmanager
def _threads(count: int) -> Iterator[None]:
    """Let torch use so many threads, and afterwards as many as before."""
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)
