"""What the ablation picture shows: each change of DA-IBC, and the ways to act of each method, by the main figures."""

from collections.abc import Callable, Mapping, Sequence

from mjdrive.evaluation.bootstrap import Interval
from mjdrive.study.pictures.figure_looks import Look, own_arms
from mjdrive.study.pictures.figures_ablation import AblationRow
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.reading import StudyFiles
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.tables.rows import Row, expert_row, interval, ratio

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
        First every change of a setting below the main arm of DA-IBC, or of the first method if there is none; then the
        ways to act of each method that has several. All rows of a group are by the same training seeds.
    """
    config = study.record.settings
    own = own_arms(config)
    arms = {it.name: it for it in config.arms}
    methods = {it.name: it.method for it in config.variants}
    changes = {it.name: it.change for it in config.variants}
    by_method: dict[str, list[str]] = {}
    for name in own:
        by_method.setdefault(methods[arms[name].variant], []).append(name)
    base = by_method.get("da-ibc", [own[0]])[0]
    changed = [it.name for it in config.arms if it.name not in own]
    labels = {name: looks[name].label for name in own}
    labels |= {name: arms[name].change or changes[arms[name].variant] for name in changed}
    groups = [*([[base, *changed]] if changed else []), *by_method.values()]
    return tuple(
        tuple(
            _row(study, row, looks[name]) for name, row in same_seeds(study.results, names, labels)
        )
        for names in groups
    )


def same_seeds(
    found: StudyResults, names: Sequence[str], labels: Mapping[str, str]
) -> list[tuple[str, Row]]:
    """Rows of arms that drove, each by the training seeds that all of them have, with the names of the arms."""
    by_arm = {name: [it for it in found.arms if it.arm == name] for name in names}
    driven = {name: results for name, results in by_arm.items() if results}
    shared = set.intersection(*({it.seed for it in results} for results in driven.values()))
    return [
        (name, Row(labels[name], tuple(it for it in results if it.seed in shared)))
        for name, results in driven.items()
    ]


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
