"""Who learns and who drives in a study: agents, and agents in their ways to act."""

from dataclasses import dataclass, replace

from mjdrive.config import Arm, StudyConfig, Variant
from mjdrive.errors import ConfigError
from mjdrive.learning.settings import acting_changed, learner_settings
from models.config import LearnerConfig


@dataclass(frozen=True, slots=True)
class Agent:
    """A variant with a training seed: what is trained once.

    Attributes:
        variant: Its method and settings.
        seed: Training seed [-].
    """

    variant: Variant
    seed: int

    @property
    def name(self) -> str:
        """Of its folder."""
        return f"{self.variant.name}-{self.seed}"


@dataclass(frozen=True, slots=True)
class ArmAgent:
    """An agent in one way to act.

    Attributes:
        arm: How it acts.
        agent: What it has learnt.
        is_main: Whether this is the main arm of its variant.
    """

    arm: Arm
    agent: Agent
    is_main: bool

    @property
    def name(self) -> str:
        """Of its files."""
        return f"{self.arm.name}-{self.agent.seed}"


def agents(config: StudyConfig) -> tuple[Agent, ...]:
    """What a study trains: by variant, then by seed."""
    return tuple(
        Agent(variant, seed)
        for variant in config.variants
        for seed in _training_seeds(config, variant)
    )


def _training_seeds(config: StudyConfig, variant: Variant) -> tuple[int, ...]:
    if variant.change and not variant.like_methods:
        return config.ablation_seeds
    return config.seeds if variant.all_seeds else config.detail_seeds


def arm_agents(config: StudyConfig) -> tuple[ArmAgent, ...]:
    """What drives in a study: by arm, then by seed; ablations of acting alone take agents with the seeds of ablations."""
    trained = agents(config)
    main = {arm.variant: arm.name for arm in reversed(config.arms)}
    return tuple(
        ArmAgent(arm, agent, is_main=main[arm.variant] == arm.name)
        for arm in config.arms
        for agent in trained
        if agent.variant.name == arm.variant
        and (not arm.change or agent.seed in config.ablation_seeds)
        and (arm.all_seeds or agent.seed in config.detail_seeds)
    )


def main_arm(config: StudyConfig, variant: str) -> Arm:
    """The first arm of a variant."""
    return next(arm for arm in config.arms if arm.variant == variant)


def ablations(config: StudyConfig) -> tuple[tuple[Arm, ...], ...]:
    """Groups of arms: first the main arm of a variant, then every arm that changes it.

    What is trained anew changes `Variant.base`, what acts in another way changes its own variant; an arm of the study
    itself can stand there, too, by `Arm.as_ablation`. A group whose base does not drive in this study begins with its first change.
    """
    variants = {it.name: it for it in config.variants}
    changed: dict[str, list[Arm]] = {}
    for arm in config.arms:
        variant = variants[arm.variant]
        is_row = arm.change or (arm.as_ablation and arm != main_arm(config, variant.name))
        row = replace(arm, change=arm.change or arm.as_ablation)
        if variant.change:
            changed.setdefault(variant.base or variant.method, []).append(row)
        elif is_row:
            changed.setdefault(variant.name, []).append(row)
    return tuple(
        (*((main_arm(config, base),) if base in variants else ()), *arms)
        for base, arms in changed.items()
    )


def learner_config(variant: Variant) -> LearnerConfig:
    """Settings that a variant is trained with.

    Raises:
        ConfigError: If one has no meaning.
        UnknownNameError: If there is no such method, preset or setting.
    """
    return learner_settings(variant.method, preset=variant.preset, assignments=variant.assignments)


def arm_settings(config: StudyConfig, arm: Arm) -> LearnerConfig:
    """Settings that the agents of an arm act with.

    Raises:
        ConfigError: If one has no meaning, or decides what is learnt.
        UnknownNameError: If there is no such method, preset or setting.
    """
    variant = next(it for it in config.variants if it.name == arm.variant)
    return acting_changed(learner_config(variant), arm.acting)


def require_buildable(config: StudyConfig) -> None:
    """Refuse a study with settings that no learner has, before anything runs.

    Raises:
        ConfigError: If a setting has no meaning; it names the variant or the arm.
        UnknownNameError: If there is no such method, preset or setting.
    """
    for variant in config.variants:
        learner_config(variant)
    for arm in config.arms:
        try:
            arm_settings(config, arm)
        except ConfigError as error:
            raise ConfigError(f"The arm {arm.name} of the study cannot act: {error}") from error
