"""What the ablation picture shows: each change of DA-IBC, and the ways to act of each method, by the main figures."""

from collections.abc import Callable, Mapping

from mjdrive.evaluation.bootstrap import Interval
from mjdrive.study.figure_looks import Look, own_arms
from mjdrive.study.figures_ablation import AblationRow
from mjdrive.study.measures import DriveFigures
from mjdrive.study.reading import StudyFiles
from mjdrive.study.results import ArmResult
from mjdrive.study.rows import Row, interval, ratio

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
        ways to act of each method that has several.
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
    changed = [
        _row(study, it.name, it.change or changes[it.variant], looks)
        for it in config.arms
        if it.name not in own
    ]
    labelled = {name: _row(study, name, looks[name].label, looks) for name in own}
    groups = [tuple(labelled[name] for name in names) for names in by_method.values()]
    return ((labelled[base], *changed), *groups) if changed else tuple(groups)


def _row(study: StudyFiles, arm: str, label: str, looks: Mapping[str, Look]) -> AblationRow:
    row = Row(label, tuple(it for it in study.results.arms if it.arm == arm))
    expert = [it for it in study.results.references if it.arm == "expert"]
    distances = row.per_drive(lambda drive: drive.distance_m)
    ratios = [
        ratio(distances, Row("", (it,)).per_drive(lambda drive: drive.distance_m)) for it in expert
    ]
    return AblationRow(
        label=label,
        colour=looks[arm].colour,
        intervals=(
            ratios[0] if ratios else None,
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
