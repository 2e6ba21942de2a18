"""What the ablation picture shows: each change of DA-IBC, and the ways to act of each method, by the main figures."""

from collections.abc import Callable, Mapping

from mjdrive.evaluation.bootstrap import Interval
from mjdrive.study.pictures.figure_looks import Look, own_arms
from mjdrive.study.pictures.figures_ablation import AblationRow
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.reading import StudyFiles
from mjdrive.study.records.results import ArmResult
from mjdrive.study.tables.rows import (
    Row,
    ablation_labels,
    expert_row,
    interval,
    ratio,
    same_seeds,
)

COLUMNS = (
    "distance / expert's",
    "penalty per episode",
    "branch recall",
    "JS of turns [bit]",
    "off road per episode [s]",
)
"""Titles of the main figures."""


def ablation_groups(
    study: StudyFiles, looks: Mapping[str, Look]
) -> tuple[tuple[AblationRow, ...], ...]:
    """Put changes below what they change.

    Args:
        study: What was found.
        looks: Of each arm, by name.

    Returns:
        First each group of single changes below what they change; then the ways to act of each method that has several.
        All rows of a group are by the same training seeds.
    """
    config = study.record.settings
    methods = {it.name: it.method for it in config.variants}
    arms = {it.name: it for it in config.arms}
    by_method: dict[str, dict[str, str]] = {}
    for name in own_arms(config):
        by_method.setdefault(methods[arms[name].variant], {})[name] = looks[name].label
    groups = [
        tuple(_row(study, row, looks[name]) for name, row in same_seeds(study.results, labels))
        for labels in (*ablation_labels(config), *by_method.values())
    ]
    return tuple(group for group in groups if len(group) > 1) or tuple(groups[:1])


def reference_row(study: StudyFiles, looks: Mapping[str, Look]) -> AblationRow | None:
    """The expert on its random walks, which all rows are compared with; None if it did not drive.

    Args:
        study: What was found.
        looks: Of each arm and reference, by name.
    """
    expert = expert_row(study.results)
    return None if expert is None else _row(study, expert, looks["expert"])


def _row(study: StudyFiles, row: Row, look: Look) -> AblationRow:
    expert = expert_row(study.results)
    distances = row.per_drive(lambda drive: drive.distance_m)
    theirs = None if expert is None else expert.per_drive(lambda drive: drive.distance_m)
    return AblationRow(
        label=row.label,
        colour=look.colour,
        intervals=(
            None if theirs is None else ratio(distances, theirs),
            _per_drive(row, lambda drive: drive.penalty),
            _per_agent(row, lambda result: result.choices.recall),
            _per_agent(row, lambda result: result.choices.turn_divergence),
            _per_drive(row, lambda drive: drive.off_road_s),
        ),
    )


def _per_drive(row: Row, figure: Callable[[DriveFigures], float]) -> Interval:
    return interval(row.per_drive(figure))


def _per_agent(row: Row, figure: Callable[[ArmResult], float | None]) -> Interval | None:
    figures = row.per_agent(figure)
    return None if figures is None else interval(figures)
