"""Settings of a study: which agents are trained, in which ways they act, and how they are measured."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from mjdrive.config.json_files import require

Reference = Literal["expert", "right-walker"]
"""Who drives beside the agents: the PID expert on a random walk, or one that takes the rightmost exit everywhere."""

Draws = Literal["dfo", "own"]
"""Whose draws landscapes show: the paper's search on energies and else a policy's own, or a policy's own throughout."""

_NAME = re.compile(r"[a-z0-9][a-z0-9.-]*")


@dataclass(frozen=True, slots=True)
class Demonstrations:
    """A data set that agents of a study learn from.

    Attributes:
        name: Of its folder.
        preset: Settings of `mjdrive collect`.
        routes: Names of the routes to drive; those of the preset if empty.
        random_walk_km: Drive so far with random turns instead of along the routes; 0 for the routes [km].
    """

    name: str
    preset: str = "standard"
    routes: tuple[str, ...] = ()
    random_walk_km: float = 0.0


@dataclass(frozen=True, slots=True)
class Variant:
    """A method with its settings; with a training seed it is an agent.

    Attributes:
        name: Unique in the study.
        method: How it learns.
        preset: Settings of the learner.
        assignments: Changes to the preset, each as "negatives.count=64".
        demonstrations: Name of what it learns from.
        change: What sets an ablation apart, in words; empty for a method of the study itself.
        base: Name of the variant that an ablation changes; that whose name is its method if empty.
        all_seeds: Whether it is trained with all seeds, or with `StudyConfig.detail_seeds` alone; an ablation has seeds of its own.
        like_methods: Whether an ablation has the training seeds, long drives and landscapes of a method all the same.
    """

    name: str
    method: str
    preset: str = "standard"
    assignments: tuple[str, ...] = ()
    demonstrations: str = "demonstrations"
    change: str = ""
    base: str = ""
    all_seeds: bool = True
    like_methods: bool = False


@dataclass(frozen=True, slots=True)
class Arm:
    """A variant and a way to act; the first arm of a variant is its main one.

    Attributes:
        name: Unique in the study.
        variant: Name of the variant.
        label: What tables and figures call it.
        acting: Changes to the settings that the variant was trained with, each as "sampler.kind=grid".
        change: What sets an ablation apart, in words; empty for an arm of the study itself.
        all_seeds: Whether the agents of all training seeds act so, or those of `StudyConfig.detail_seeds` alone.
        is_long: Whether it makes the long drive though it is not the main arm, which always does.
        as_ablation: What it changes, in words, for a row among the ablations beside those of the other tables; empty for none of its own.
    """

    name: str
    variant: str
    label: str
    acting: tuple[str, ...] = ()
    change: str = ""
    all_seeds: bool = True
    is_long: bool = False
    as_ablation: str = ""


@dataclass(frozen=True, slots=True)
class StudyConfig:
    """All that decides the results of a study.

    Attributes:
        preset: What it was made from.
        variants: What is trained.
        arms: What drives.
        demonstrations: What is learnt from.
        references: Who drives beside the agents.
        expert_walks: How often the expert drives from the same starts, with other random turns each time [-].
        seeds: Training seeds of the methods [-].
        ablation_seeds: Training seeds of the ablations, some of `seeds` [-].
        learning_town: Where demonstrations are collected.
        threads: Threads of each training, which decide how its sums are rounded and so its weights [-].
        town: Where agents drive; a town that they have not seen.
        seed: Decides demonstrations, starts and lights of all drives, and what is drawn [-].
        episodes: Drives of each agent in each of its ways to act [-].
        steps: Control steps of each of them [-].
        long_steps: Control steps of one more drive of each main arm and each `Arm.is_long`, for its path and what it sees in time; 0 for none [-].
        detail_seeds: Training seeds, some of `seeds`, whose agents make it, and whose landscapes and turns are kept [-].
        landscape_draws: Whose draws the landscapes show: "dfo" lets energies be searched as the paper does, "own" is as the arm draws.
        progress_every: Epochs between two checkpoints that drive, for the progress of training; 0 for none [-].
        progress_episodes: Drives of each such checkpoint [-].
        progress_steps: Control steps of each of them [-].
        forks: Moments before junctions that are lived again and again [-].
        fork_rollouts: How often [-].
        held_out_km: Length of the expert's walk through the town that says how likely its actions are; 0 for none [km].
        held_out_frames: Moments of it that are looked at [-].
    """

    preset: str
    variants: tuple[Variant, ...]
    arms: tuple[Arm, ...]
    demonstrations: tuple[Demonstrations, ...] = (Demonstrations("demonstrations"),)
    references: tuple[Reference, ...] = ("expert", "right-walker")
    expert_walks: int = 5
    seeds: tuple[int, ...] = (0, 1, 2)
    ablation_seeds: tuple[int, ...] = (0,)
    learning_town: str = "town01"
    threads: int = 1
    town: str = "town02"
    seed: int = 0
    episodes: int = 10
    steps: int = 3000
    long_steps: int = 30_000
    detail_seeds: tuple[int, ...] = (0,)
    landscape_draws: Draws = "dfo"
    progress_every: int = 2
    progress_episodes: int = 2
    progress_steps: int = 1000
    forks: int = 2
    fork_rollouts: int = 50
    held_out_km: float = 1.0
    held_out_frames: int = 256

    def __post_init__(self) -> None:
        self._check_names()
        for name in ("episodes", "steps", "progress_episodes", "progress_steps", "held_out_frames"):
            _check(self, name, getattr(self, name) >= 1, "at least 1")
        for name in ("threads", "expert_walks"):
            _check(self, name, getattr(self, name) >= 1, "at least 1")
        for name in ("long_steps", "progress_every", "forks", "held_out_km"):
            _check(self, name, getattr(self, name) >= 0, "0 or more")
        _check(self, "held_out_km", math.isfinite(self.held_out_km), "a finite number")
        _check(self, "fork_rollouts", self.fork_rollouts >= 1, "at least 1")
        _check(self, "long_steps", self.long_steps != 1, "0 or at least 2")
        for name in ("seeds", "ablation_seeds", "detail_seeds"):
            seeds = getattr(self, name)
            good = len(set(seeds)) == len(seeds) and all(0 <= seed < 2**32 for seed in seeds)
            _check(self, name, good, "different numbers from 0 to 4294967295")
        _check(self, "seeds", len(self.seeds) >= 1, "at least one")
        for name in ("ablation_seeds", "detail_seeds"):
            known = ", ".join(map(str, self.seeds))
            _check(
                self, name, set(getattr(self, name)) <= set(self.seeds), f"some of seeds, {known}"
            )

    def _check_names(self) -> None:
        """Refuse names that are no folder names, that are there twice, or that name nothing."""
        for kind, things in (
            ("demonstrations", self.demonstrations),
            ("variants", self.variants),
            ("arms", self.arms),
        ):
            names = [thing.name for thing in things]
            good = len(set(names)) == len(names) and all(_NAME.fullmatch(name) for name in names)
            require(
                good and bool(names),
                f"{kind} are called {', '.join(names) or 'nothing'}; expected different names of small letters, "
                f"digits, dots and dashes.",
            )
        _require_among(
            "demonstrations",
            {it.demonstrations for it in self.variants},
            names_of(self.demonstrations),
        )
        _require_among("variants", {it.variant for it in self.arms}, names_of(self.variants))
        _require_among("arms", names_of(self.variants), {it.variant for it in self.arms})


def names_of(things: Sequence[Demonstrations] | Sequence[Variant] | Sequence[Arm]) -> set[str]:
    """The names of what a study lists."""
    return {thing.name for thing in things}


def _require_among(kind: str, wanted: set[str], known: set[str]) -> None:
    """Refuse names of things that the study does not list, or variants that do not drive."""
    missing = sorted(wanted - known)
    require(
        not missing,
        f"The study has no {kind} for {', '.join(missing)}; expected some of {', '.join(sorted(known))}.",
    )


def _check(config: StudyConfig, name: str, condition: bool, expected: str) -> None:
    require(condition, f"{name} is {getattr(config, name)}; expected {expected}.")
