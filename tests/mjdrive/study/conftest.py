"""Studies of seconds, and what they left."""

import dataclasses
from pathlib import Path

import pytest

from mjdrive.config import Arm, Demonstrations, StudyConfig, Variant
from mjdrive.study.study import Study

SMALL = ("optimiser.epochs=3", "negatives.count=8", "sampler.grid.points=9")


def tell_nobody(stage: str, count: int) -> object:
    return lambda thing, done, expected: None


@pytest.fixture(scope="session")
def tiny() -> StudyConfig:
    """Two methods, each trained for three steps on 50 m of driving; each drive is of a few steps."""
    return StudyConfig(
        preset="tiny",
        variants=(
            Variant("bc-beta", "bc-beta", preset="quick", assignments=SMALL),
            Variant("da-ibc", "da-ibc", preset="quick", assignments=SMALL),
        ),
        arms=(
            Arm(
                "bc-beta-sample",
                "bc-beta",
                "BC-Beta, sampled",
                ("beta.inference=sample", "commitment.hold=0"),
            ),
            Arm("da-ibc-sample", "da-ibc", "DA-IBC, sampled"),
            Arm("da-ibc-argmin", "da-ibc", "DA-IBC, lowest", ("sampler.grid.choice=argmin",)),
        ),
        demonstrations=(Demonstrations("demonstrations", random_walk_km=0.05),),
        expert_walks=2,
        seeds=(3,),
        ablation_seeds=(),
        detail_seeds=(3,),
        episodes=2,
        steps=12,
        long_steps=20,
        landscape_draws="own",  # the paper's search takes seconds a moment here
        progress_every=2,
        progress_episodes=1,
        progress_steps=5,
        forks=1,
        fork_rollouts=1,
        held_out_km=0.05,
        held_out_frames=3,
    )


@pytest.fixture(scope="session")
def tiny_folder(tiny: StudyConfig, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of that study; nobody writes into it."""
    folder = tmp_path_factory.mktemp("studies") / "tiny"
    Study(tiny, folder).run(tell_nobody)
    return folder


@pytest.fixture(scope="session")
def tiniest(tiny: StudyConfig) -> StudyConfig:
    """A part of that study: one agent with one way to act, and every stage with as little to do as can be."""
    return dataclasses.replace(
        tiny,
        preset="tiniest",
        variants=tiny.variants[:1],
        arms=tiny.arms[:1],
        references=("expert",),
        expert_walks=1,
        long_steps=0,
        progress_every=0,
    )


@pytest.fixture(scope="session")
def tiniest_folder(tiniest: StudyConfig, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of that part; nobody writes into it."""
    folder = tmp_path_factory.mktemp("studies") / "tiniest"
    Study(tiniest, folder).run(tell_nobody)
    return folder
