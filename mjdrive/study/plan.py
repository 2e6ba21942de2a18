"""What a study has to do: its jobs, all of them, in the order of its results."""

from dataclasses import dataclass
from pathlib import Path

from mjdrive.config import Reference, StudyConfig
from mjdrive.datatypes import Town
from mjdrive.evaluation.drives import plan_drives
from mjdrive.study.jobs import checkpoints, drivers
from mjdrive.study.jobs.drivers import Who
from mjdrive.study.jobs.driving import DriveJob
from mjdrive.study.jobs.forks import ForkJob, chosen_approaches
from mjdrive.study.jobs.judging import JudgeJob
from mjdrive.study.records import results
from mjdrive.study.records.folder import StudyFolder
from mjdrive.study.settings.agents import ArmAgent, agents, arm_agents, arm_settings, main_arm
from models.config import Precision

LONG = "long"
"""Name of the long drive."""


@dataclass(frozen=True, slots=True)
class ArmPlan:
    """What one agent in one way to act has to do.

    Attributes:
        it: The agent and how it acts; None for a reference.
        who: The same as somebody who drives.
        drives: The drives of the tables.
        long_drive: The long one; None if it makes none.
        forks: Moments to live; none for a reference.
        judge: What to ask; None for a reference.
    """

    it: ArmAgent | None
    who: Who
    drives: tuple[DriveJob, ...]
    long_drive: DriveJob | None
    forks: tuple[ForkJob, ...]
    judge: JudgeJob | None

    @property
    def all_drives(self) -> tuple[DriveJob, ...]:
        """All its drives, the long one last."""
        return (*self.drives, *(() if self.long_drive is None else (self.long_drive,)))


@dataclass(frozen=True, slots=True)
class ProgressPlan:
    """A checkpoint that drives.

    Attributes:
        arm: Name of the main arm.
        variant: Name of the variant.
        seed: Training seed [-].
        epoch: Complete epochs [-].
        loss: Mean loss of the last of them [nats].
        drives: Its drives.
    """

    arm: str
    variant: str
    seed: int
    epoch: int
    loss: float
    drives: tuple[DriveJob, ...]


def plan_references(config: StudyConfig, folder: StudyFolder) -> tuple[ArmPlan, ...]:
    """What the references drive."""
    return tuple(
        _plan_reference(name, walk, config, folder)
        for name in config.references
        for walk in range(config.expert_walks if name == "expert" else 1)
    )


def plan_arms(
    config: StudyConfig,
    folder: StudyFolder,
    runs: dict[str, Path],
    town: Town,
    *,
    precision: Precision,
) -> tuple[ArmPlan, ...]:
    """What the agents do once they are trained.

    Args:
        config: Settings of the study.
        folder: Its folder.
        runs: Run folder of each agent, by name.
        town: Where they drive.
        precision: Number format to score actions in where their settings leave it open.
    """
    approaches = chosen_approaches(town, config.forks)
    return tuple(
        _plan_arm(
            it,
            config,
            folder,
            drivers.agent(it.name, runs[it.agent.name], arm_settings(config, it.arm), precision),
            approaches,
        )
        for it in arm_agents(config)
    )


def plan_progress(
    config: StudyConfig, folder: StudyFolder, runs: dict[str, Path], *, precision: Precision
) -> tuple[ProgressPlan, ...]:
    """What the kept checkpoints of the methods drive; ablations make no progress that anybody looks at.

    Args:
        config: Settings of the study.
        folder: Its folder.
        runs: Run folder of each agent, by name.
        precision: Number format to score actions in where their settings leave it open.
    """
    if config.progress_every == 0:
        return ()
    found = []
    for agent in agents(config):
        if agent.variant.change:
            continue
        run, arm = runs[agent.name], main_arm(config, agent.variant.name)
        losses = checkpoints.losses(run)
        for epoch, checkpoint in sorted(checkpoints.kept_epochs(run).items()):
            who = drivers.agent(
                f"{arm.name}-{agent.seed}-epoch-{epoch:04d}",
                checkpoint,
                arm_settings(config, arm),
                precision,
            )
            drives = _drives(
                who, config, folder, count=config.progress_episodes, steps=config.progress_steps
            )
            found.append(
                ProgressPlan(arm.name, agent.variant.name, agent.seed, epoch, losses[epoch], drives)
            )
    return tuple(found)


def _plan_reference(
    name: Reference, walk: int, config: StudyConfig, folder: StudyFolder
) -> ArmPlan:
    """Every walk of the expert makes the drives of the tables; the first one makes the long drive, too."""
    who = Who(f"{name}-{walk}", reference=name, walk=walk)
    return ArmPlan(
        it=None,
        who=who,
        drives=_drives(who, config, folder, count=config.episodes, steps=config.steps),
        long_drive=_long_drive(who, name, walk, config, folder) if walk == 0 else None,
        forks=(),
        judge=None,
    )


def _plan_arm(
    it: ArmAgent, config: StudyConfig, folder: StudyFolder, who: Who, approaches: tuple[str, ...]
) -> ArmPlan:
    seed = it.agent.seed
    variant = it.agent.variant
    is_detailed = (not variant.change or variant.like_methods) and seed in config.detail_seeds
    is_shown = it.is_main and is_detailed
    is_long = is_shown or (it.arm.is_long and is_detailed)
    forks = tuple(
        ForkJob(
            who=who,
            arm=it.arm.name,
            agent_seed=seed,
            approach=approach,
            file=folder.forks(who.name, index),
            turns=folder.path / results.TURNS if is_shown and index == 0 else None,
            num_rollouts=config.fork_rollouts,
            seed=config.seed,
        )
        for index, approach in enumerate(approaches)
    )
    judge = JudgeJob(
        who=who,
        arm=it.arm.name,
        variant=variant.name,
        agent_seed=seed,
        file=folder.judged(who.name),
        landscapes=folder.path / results.LANDSCAPES if is_shown else None,
        draws=config.landscape_draws,
        seed=config.seed,
    )
    return ArmPlan(
        it=it,
        who=who,
        drives=_drives(who, config, folder, count=config.episodes, steps=config.steps),
        long_drive=_long_drive(who, it.arm.name, seed, config, folder) if is_long else None,
        forks=forks,
        judge=judge,
    )


def _drives(
    who: Who, config: StudyConfig, folder: StudyFolder, *, count: int, steps: int
) -> tuple[DriveJob, ...]:
    return tuple(
        DriveJob(who, folder.drive(who.name, planned.name), planned.seed, steps)
        for planned in plan_drives(count, seed=config.seed)
    )


def _long_drive(
    who: Who, arm: str, seed: int, config: StudyConfig, folder: StudyFolder
) -> DriveJob | None:
    """The long drive has a start of its own: that of the drive after the last one of the tables."""
    if config.long_steps == 0:
        return None
    planned = plan_drives(config.episodes + 1, seed=config.seed)[-1]
    file = folder.drive(who.name, LONG)
    return DriveJob(who, file, planned.seed, config.long_steps, path_of=(arm, seed))
