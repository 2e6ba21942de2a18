"""What the tables of a study have in a row: all agents of an arm together, or a reference."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mjdrive.config import StudyConfig
from mjdrive.evaluation import bootstrap
from mjdrive.evaluation.bootstrap import Interval, Statistic
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.settings.agents import ablations

REFERENCE_LABELS = {
    "expert": "PID expert, random walk",
    "right-walker": "PID expert, always right",
}
"""What tables call the references."""

NOTHING = "-"
"""What a cell shows where nothing was measured."""

EPISODE_STEPS, ALL_STEPS = 3000, 30_000
"""Control steps of an episode of the paper, and of all ten of an agent [-]."""


@dataclass(frozen=True, slots=True)
class Row:
    """One row.

    Attributes:
        label: What it is called.
        results: Of each agent, by training seed; of a reference, by walk.
        change: What sets an ablation apart; empty for the study's own arms and for references.
    """

    label: str
    results: tuple[ArmResult, ...]
    change: str = ""

    def per_drive(self, figure: Callable[[DriveFigures], float]) -> Float[np.ndarray, "S E"]:
        """A figure of every drive of every agent, in its own unit."""
        return np.array([[figure(drive) for drive in it.drives] for it in self.results], float)

    def per_agent(
        self, figure: Callable[[ArmResult], float | None]
    ) -> Float[np.ndarray, "S 1"] | None:
        """A figure of every agent that has it, in its own unit; None if none of them has."""
        found = [it for it in map(figure, self.results) if it is not None]
        return np.array([found], float).T if found else None


Column = tuple[str, Callable[[Row], str]]
"""Title, and what a row shows there."""


def reference_rows(found: StudyResults) -> tuple[Row, ...]:
    """The references, which are in every table."""
    return tuple(
        Row(REFERENCE_LABELS[name], tuple(it for it in found.references if it.arm == name))
        for name in dict.fromkeys(it.arm for it in found.references)
    )


def expert_row(found: StudyResults) -> Row | None:
    """All walks of the expert, which ratios are taken to; None if it did not drive."""
    label = REFERENCE_LABELS["expert"]
    return next((row for row in reference_rows(found) if row.label == label), None)


def arm_rows(config: StudyConfig, found: StudyResults) -> tuple[Row, ...]:
    """All arms in the order of the study, ablations among them."""
    changes = {variant.name: variant.change for variant in config.variants}
    rows = (
        Row(
            arm.label,
            tuple(it for it in found.arms if it.arm == arm.name),
            arm.change or changes[arm.variant],
        )
        for arm in config.arms
    )
    return tuple(row for row in rows if row.results)


def ablation_labels(config: StudyConfig) -> tuple[dict[str, str], ...]:
    """Groups of arms by name: first what is changed, by its label, then by its change each arm that changes it."""
    changes = {variant.name: variant.change for variant in config.variants}
    return tuple(
        {base.name: base.label} | {it.name: it.change or changes[it.variant] for it in changed}
        for base, *changed in ablations(config)
    )


def same_seeds(found: StudyResults, labels: Mapping[str, str]) -> list[tuple[str, Row]]:
    """Rows of those arms that drove, each by the training seeds that all of them have, with the names of the arms.

    Args:
        found: What was found.
        labels: What to call each arm, by its name.
    """
    driven = {name: [it for it in found.arms if it.arm == name] for name in labels}
    driven = {name: results for name, results in driven.items() if results}
    if not driven:
        return []
    shared = set.intersection(*({it.seed for it in results} for results in driven.values()))
    return [
        (name, Row(labels[name], tuple(it for it in results if it.seed in shared)))
        for name, results in driven.items()
    ]


def has_size_of_the_paper(config: StudyConfig) -> bool:
    """Whether episodes are as long and as many as the paper's."""
    return (config.steps, config.episodes * config.steps) == (EPISODE_STEPS, ALL_STEPS)


def interval(*figures: Float[np.ndarray, "S E"], statistic: Statistic = bootstrap.mean) -> Interval:
    """A statistic with its bootstrap interval; the same figures give the same interval."""
    return bootstrap.interval(*figures, rng=np.random.default_rng(0), statistic=statistic)


def ratio(
    figures: Float[np.ndarray, "S E"], reference: Float[np.ndarray, "R F"]
) -> Interval | None:
    """Ratio to the mean of a reference with its bootstrap interval; None if the reference has nothing."""
    if not (reference > 0).all():
        return None
    return bootstrap.ratio_interval(figures, reference, rng=np.random.default_rng(0))


def drive_cell(
    row: Row, *figures: Callable[[DriveFigures], float], statistic: Statistic = bootstrap.mean
) -> str:
    """What a statistic makes of figures of single drives, with its interval over agents and drives.

    Args:
        row: Agents or a reference.
        *figures: Of a drive, as many as the statistic takes.
        statistic: What is made of them.
    """
    return cell(*map(row.per_drive, figures), statistic=statistic)


def drive_column(
    *figures: Callable[[DriveFigures], float], statistic: Statistic = bootstrap.mean
) -> Callable[[Row], str]:
    """The same for any row."""
    return lambda row: drive_cell(row, *figures, statistic=statistic)


def agent_cell(row: Row, figure: Callable[[ArmResult], float | None], *, digits: int = 2) -> str:
    """Mean and interval over the agents that have a figure, and how many those are unless all have it."""
    figures = row.per_agent(figure)
    if figures is None:
        return NOTHING
    text = cell(figures, digits=digits)
    return (
        text
        if len(figures) == len(row.results)
        else f"{text} ({len(figures)} of {len(row.results)})"
    )


def training_seeds(row: Row) -> str:
    """How many agents a row is made of; references are not trained."""
    return str(len(row.results)) if row.results[0].variant else NOTHING


def cell(
    *figures: Float[np.ndarray, "S E"], statistic: Statistic = bootstrap.mean, digits: int = 2
) -> str:
    """A statistic and its interval as a table has them; without the interval where there is one figure alone."""
    found = interval(*figures, statistic=statistic)
    if math.isnan(found.value):
        return NOTHING
    text = number(found.value, digits=digits)
    if figures[0].size == 1:
        return text
    low, high = (f"{it:,.{_shown(found.value, digits)}f}" for it in (found.low, found.high))
    return f"{text} [{low}, {high}]"


def _shown(value: float, digits: int) -> int:
    return 0 if abs(value) >= 100 else digits


def number(value: float | None, *, digits: int = 2) -> str:
    """A figure without an interval, as a table has it."""
    if value is None:
        return NOTHING
    return f"{value:,.{_shown(value, digits)}f}"


def markdown(head: Sequence[str], body: Sequence[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def agents_table(
    config: StudyConfig,
    found: StudyResults,
    columns: Sequence[Column],
    others: Sequence[Sequence[str]] = (),
) -> str:
    """References and all arms that are no ablations, with the number of training seeds, in Markdown.

    Args:
        config: Settings of the study.
        found: Its results.
        columns: What is shown of each.
        others: Rows that are text already, which stand below them.
    """
    columns = (("training seeds", training_seeds), *columns)
    rows = [*reference_rows(found), *(it for it in arm_rows(config, found) if not it.change)]
    measured = [[row.label, *(show(row) for _, show in columns)] for row in rows]
    return markdown(["", *(title for title, _ in columns)], [*measured, *others])


def duration(steps: int) -> str:
    """Simulated time of some control steps, in words."""
    return f"{0.1 * steps:,.0f} s"


def turn_balance(shares: Mapping[str, float]) -> str:
    """Shares of left, straight and right in words, from shares by the name of the move [-]."""
    each = (f"{100 * shares.get(move, 0.0):.0f}" for move in ("left", "straight", "right"))
    return f"{' / '.join(each)} %"
