"""What a study found, as its JSON files hold it; tables, figures and the report are made from these alone.

study.json                            StudyConfig, versions and digests (`StudyRecord`)
results.json                          `StudyResults`: every figure of every table
landscapes/<arm>-<seed>-<moment>.json `LandscapeRecord`: what an agent thinks of each action at one moment
fans/<arm>-<seed>-<index>.json        `fans.FanRecord`: one moment before a junction, lived many times
paths/<arm>-<seed>.json               `DrivenPath`: where the long drive of an agent led
turns/<arm>-<seed>-<exit>.hdf5        one drive through each exit of one junction, for videos (`Turn` lists them)
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from mjdrive.config import Draws, StudyConfig
from mjdrive.evaluation.choices import ChoiceStatistics
from mjdrive.evaluation.forking import ForkOutcome
from mjdrive.study.records.measures import Curve, DriveFigures, LandscapeFigures, Likelihood
from mjdrive.study.records.situations import Moment
from models.config import Precision

STUDY = "study.json"
RESULTS = "results.json"
LANDSCAPES = "landscapes"
PATHS = "paths"
FANS = "fans"
TURNS = "turns"


@dataclass(frozen=True, slots=True)
class StudyRecord:
    """What a study is: written first, and compared when it goes on.

    Attributes:
        settings: All that decides its results.
        learners: Settings that each variant is trained with, by its name, as JSON values by their dotted names.
        versions: Versions of the software.
        code: SHA-256 of the sources of mjdrive and models, hexadecimal: records hold figures that code derived.
        precision: Number format of actions where settings leave it open: that of the CPU that it began on.
        device: Kind of device that trains, "cpu" or "cuda".
        towns: Digest of each town that is driven in, by name.
        car: Digest of the car that drives.
        data: Digest of the manifest of each data set that was there before, by name; the study collects the others.
        runs: Digest of the weights of each agent that was trained before, by name; the study trains the others.
        command: With which it was begun, all options included; empty if that was none. It may go on with another one.
    """

    settings: StudyConfig
    learners: Mapping[str, dict[str, Any]]
    versions: Mapping[str, str]
    code: str
    precision: Precision
    device: str
    towns: Mapping[str, str]
    car: str
    data: Mapping[str, str] = field(default_factory=dict)
    runs: Mapping[str, str] = field(default_factory=dict)
    command: str = ""


@dataclass(frozen=True, slots=True)
class ArmResult:
    """One agent in one way to act, or a reference.

    Attributes:
        arm: Name of the arm, or of the reference.
        variant: Name of the variant; empty for a reference.
        seed: Training seed; of a reference, the number of its walk [-].
        digest: SHA-256 of the weights, hexadecimal; empty for a reference.
        drives: The drives of the tables, in the order of their seeds; those of all arms begin alike.
        long_drive: The long drive; None if it made none.
        choices: What it chose at junctions in `drives`.
        all_choices: The same in `drives` and `long_drive`.
        recall: Branch recall over time in `drives` and then `long_drive`; x in [s].
        coverage: Share of the town's directed lanes visited over distance in `drives`; x in [km].
        all_coverage: The same in `drives` and then `long_drive`.
        forks: What it made of moments before junctions; none for a reference.
        likelihood: How likely it finds what the expert does; None for a reference.
        landscape: How many ways to act it sees; None for a reference.
    """

    arm: str
    variant: str
    seed: int
    digest: str
    drives: tuple[DriveFigures, ...]
    long_drive: DriveFigures | None
    choices: ChoiceStatistics
    all_choices: ChoiceStatistics
    recall: Curve
    coverage: Curve
    all_coverage: Curve
    forks: tuple[ForkOutcome, ...]
    likelihood: Likelihood | None
    landscape: LandscapeFigures | None


@dataclass(frozen=True, slots=True)
class ProgressPoint:
    """An agent before the end of its training, in its main way to act.

    Attributes:
        arm: Name of the main arm.
        variant: Name of the variant.
        seed: Training seed [-].
        epoch: Complete epochs [-].
        loss: Mean loss of the last of them [nats].
        drives: Its drives, shorter and fewer than those of the tables.
    """

    arm: str
    variant: str
    seed: int
    epoch: int
    loss: float
    drives: tuple[DriveFigures, ...]


@dataclass(frozen=True, slots=True)
class DataResult:
    """A data set that was learnt from, and its own turn balance.

    Attributes:
        name: Of the data set in the study.
        town: Where it was driven.
        episodes: Drives [-].
        samples: Pairs of observation and action [-].
        manifest_sha256: Digest of its manifest, hexadecimal.
        choices: What its expert chose at junctions.
    """

    name: str
    town: str
    episodes: int
    samples: int
    manifest_sha256: str
    choices: ChoiceStatistics


@dataclass(frozen=True, slots=True)
class Turn:
    """A drive of an agent through one exit of a junction, kept to be looked at.

    Attributes:
        arm: Name of the arm.
        seed: Training seed [-].
        approach: Name of the lane that it came from.
        exit: Name of the junction lane that it took.
        move: Which way that leads: "left", "straight" or "right".
        file: Its episode, in the folder of the study.
    """

    arm: str
    seed: int
    approach: str
    exit: str
    move: str
    file: str


@dataclass(frozen=True, slots=True)
class StudyResults:
    """Every figure of a study.

    Attributes:
        data: What was learnt from.
        references: Who drove beside the agents.
        arms: The agents in their ways to act: by arm in the order of the study, then by seed.
        progress: The agents while they were trained: by variant, seed and epoch.
        turns: Drives through the exits of one junction.
        landscapes: Names of the landscape files.
        paths: Names of the path files.
        fans: Names of the fan files.
        pooled: What all agents of an arm, or a reference, chose in `drives` together, by the name of the arm.
    """

    data: tuple[DataResult, ...]
    references: tuple[ArmResult, ...]
    arms: tuple[ArmResult, ...]
    progress: tuple[ProgressPoint, ...]
    turns: tuple[Turn, ...]
    landscapes: tuple[str, ...]
    paths: tuple[str, ...]
    fans: tuple[str, ...] = ()
    pooled: Mapping[str, ChoiceStatistics] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class LandscapeRecord:
    """What an agent thinks of every action at one moment; `mjdrive.study.jobs.landscapes` measures it.

    Attributes:
        arm: Name of the main arm of the variant.
        variant: Name of the variant.
        seed: Training seed [-].
        moment: When it was asked; the bird's-eye view is drawn again from it.
        points: Points along each action component [-].
        probabilities: Of the points of the grid, acceleration outermost, one row after the other [-].
        draws: Actions that were drawn, each anew, acceleration and steering [-].
        drawn_by: By the paper's search ("dfo"), or as the main arm draws ("own").
    """

    arm: str
    variant: str
    seed: int
    moment: Moment
    points: int
    probabilities: tuple[float, ...]
    draws: tuple[tuple[float, float], ...]
    drawn_by: Draws = "own"


@dataclass(frozen=True, slots=True)
class DrivenPath:
    """Where a long drive led in its first 3,000 s, five times as coarse as it was driven.

    Attributes:
        arm: Name of the arm, or of the reference.
        seed: Training seed; 0 for a reference [-].
        town: Where.
        duration_s: Simulated time [s].
        points: Rear axle twice a second, world frame [m].
        red_lights: Where red lights were run, world frame [m].
        mishaps: Where it hit something or left the road, world frame [m].
    """

    arm: str
    seed: int
    town: str
    duration_s: float
    points: tuple[tuple[float, float], ...]
    red_lights: tuple[tuple[float, float], ...]
    mishaps: tuple[tuple[float, float], ...]
