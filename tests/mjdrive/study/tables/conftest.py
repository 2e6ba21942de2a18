"""A study that was made up, so that every number of its tables is known."""

import dataclasses
from collections.abc import Callable

import pytest

from mjdrive.config import Arm, StudyConfig, Variant
from mjdrive.evaluation.choices import ChoiceStatistics
from mjdrive.evaluation.forking import ForkOutcome
from mjdrive.study.records.measures import Curve, DriveFigures, Likelihood
from mjdrive.study.records.results import ArmResult, DataResult, StudyResults

CHOICES = ChoiceStatistics(
    branches=48,
    taken=24,
    recall=0.5,
    passes=40,
    entropy=0.9,
    divergence=0.2,
    divergence_floor=0.1,
    turn_shares={"left": 0.25, "straight": 0.5, "right": 0.25},
    turn_divergence=0.01,
)


def _drive(distance: float = 1000.0, reds: int = 0, **changes: float) -> DriveFigures:
    figures = DriveFigures(
        seed=0,
        steps=3000,
        duration_s=300.0,
        distance_m=float(distance),
        red_lights=reds,
        lights_met=10,
        reds_met=4,
        collisions=0,
        kerb_strikes=0,
        road_departures=0,
        wrong_ways=0,
        off_road_s=0.0,
        stuck_s=0.0,
        penalty=float(0.7**reds),
        score=float(distance * 0.7**reds),
        jerk_rms=1.0,
        steering_whiteness=0.5,
        steering_unrest=2.0,
        lane_offset_rms_m=0.1,
        branches_taken={},
    )
    return dataclasses.replace(figures, **changes)  # type: ignore[arg-type]


def _result(arm: str, seed: int, *drives: DriveFigures, variant: str = "da-ibc") -> ArmResult:
    return ArmResult(
        arm=arm,
        variant=variant,
        seed=seed,
        digest="",
        drives=drives,
        long_drive=None,
        choices=CHOICES,
        all_choices=CHOICES,
        recall=Curve((0.0, 600.0), (0.0, 0.5)),
        coverage=Curve((0.0, 0.4, 0.9, 2.0), (0.0, 0.4, 0.6, 0.6)),
        all_coverage=Curve((0.0, 0.4, 0.9, 2.0), (0.0, 0.4, 0.6, 0.6)),
        forks=(ForkOutcome("approach", 50, 0.9, {"left": 20, "right": 25}, 0.99),),
        likelihood=Likelihood(100, 4.5, 0.1, 3.25),
        landscape=None,
    )


def _cells(table: str, label: str) -> dict[str, str]:
    """A row of a Markdown table by the titles of its columns."""
    head, _, *body = [line.strip("|\n ").split(" | ") for line in f"|x{table[1:]}".splitlines()]
    (row,) = [line for line in body if line[0].strip() == label]
    return dict(zip(head[1:], row[1:], strict=True))


@pytest.fixture
def choices() -> ChoiceStatistics:
    return CHOICES


@pytest.fixture
def drive() -> Callable[..., DriveFigures]:
    return _drive


@pytest.fixture
def result() -> Callable[..., ArmResult]:
    return _result


@pytest.fixture
def cells() -> Callable[[str, str], dict[str, str]]:
    return _cells


@pytest.fixture
def study() -> tuple[StudyConfig, StudyResults]:
    config = StudyConfig(
        preset="made up",
        variants=(Variant("da-ibc", "da-ibc"), Variant("plain", "da-ibc", change="plain head")),
        arms=(Arm("sample", "da-ibc", "DA-IBC, sampled"), Arm("plain", "plain", "DA-IBC, plain")),
        references=("expert",),
        seeds=(0, 1),
        ablation_seeds=(0,),
    )
    expert = dataclasses.replace(
        _result("expert", 0, _drive(2000), _drive(2000)), variant="", forks=(), likelihood=None
    )
    found = StudyResults(
        data=(DataResult("demonstrations", "town01", 10, 21_000, "a" * 64, CHOICES),),
        references=(expert,),
        arms=(
            _result("sample", 0, _drive(1000, 2), _drive(1000)),
            _result("sample", 1, _drive(1000, 1), _drive(1000, 1)),
            _result("plain", 0, _drive(500), _drive(500, off_road_s=3.5), variant="plain"),
        ),
        progress=(),
        turns=(),
        landscapes=(),
        paths=(),
    )
    return config, found
