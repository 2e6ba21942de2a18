"""The result to reach: policies against the expert in the same time and town, beside the bars that were set."""

from mjdrive.config import StudyConfig
from mjdrive.evaluation.bootstrap import rate
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.results import StudyResults
from mjdrive.study.tables.arm_figures import recall_by
from mjdrive.study.tables.rows import (
    NOTHING,
    Row,
    agent_cell,
    arm_rows,
    drive_cell,
    expert_row,
    has_size_of_the_paper,
    markdown,
    number,
    ratio,
    reference_rows,
    training_seeds,
)

BARS = {
    "infraction penalty per episode": ("0.66", "0.85", "0.97"),
    "distance / the expert's": ("about 1.1, red lights run", "0.90", "0.97"),
    "branch recall / the expert's": ("whole city", "0.90", "1.00"),
    "branch recall in 10,000 s": ("none", "0.95", "1.00"),
    "JS of exits, seeds pooled [bit]": (NOTHING, "0.05", "0.02"),
    "its floor [bit]": (NOTHING, NOTHING, NOTHING),
    "JS of turns [bit]": (NOTHING, "0.05", "0.02"),
    "collisions per 3,000 s": ("no crashes", "0.5", "0"),
    "off road [s] per 3,000 s": (NOTHING, "5", "0"),
}
"""What the paper says of its DA-IBC, the bar and the goal, by column.

The bar of the divergence from the expert's turns is for p(exit | approach), of the exits; it stands above the turns of the
whole town as well, where it is easier to reach: wrong turns here and there make up for each other.
"""

LONG_SECONDS = 10_000.0
"""Time that a policy should have seen the whole town in, drives and long drive together [s]."""

REFERENCE_SECONDS = 3000.0
"""Time that collisions and time off the road are counted over [s]."""


def ratio_table(config: StudyConfig, found: StudyResults) -> str:
    """Each policy beside the bars.

    Penalty, distance, collisions and time off the road have bootstrap intervals over seeds and episodes, distances with
    the expert's own chance taken into account. Recall and the divergence of turns are figures of all drives of an agent
    together, so their intervals are over training seeds alone (`multimodality_table` says why). The divergence of exits is
    that of all seeds together and has none: with the passes of one agent its floor alone may be above the bar. The bars
    are left out where they do not hold, as they are set for ten episodes of 300 s.

    Args:
        config: Settings of the study.
        found: Its results.
    """
    expert = expert_row(found)
    rows = [*reference_rows(found), *(it for it in arm_rows(config, found) if not it.change)]
    measured = [[row.label, training_seeds(row), *_cells(row, expert, found)] for row in rows]
    bars = _bars() if has_size_of_the_paper(config) else []
    return markdown(["", "training seeds", *BARS], [*bars, *measured])


def _bars() -> list[list[str]]:
    columns = ("paper's DA-IBC", "bar", "goal")
    return [
        [name, NOTHING, *(values[index] for values in BARS.values())]
        for index, name in enumerate(columns)
    ]


def _cells(row: Row, expert: Row | None, found: StudyResults) -> list[str]:
    together = found.pooled.get(row.results[0].arm)
    return [
        drive_cell(row, lambda it: it.penalty),
        distance_ratio(row, expert),
        recall_ratio(row, expert),
        _long_recall(row),
        number(together.divergence if together else None, digits=3),
        number(together.divergence_floor if together else None, digits=3),
        agent_cell(row, lambda it: it.choices.turn_divergence, digits=3),
        drive_cell(row, lambda it: it.collisions, _reference_times, statistic=rate),
        drive_cell(row, lambda it: it.off_road_s, _reference_times, statistic=rate),
    ]


def _reference_times(drive: DriveFigures) -> float:
    """How often the time that bars are set for is in a drive [-]."""
    return drive.duration_s / REFERENCE_SECONDS


def _distance(drive: DriveFigures) -> float:
    return drive.distance_m


def distance_ratio(row: Row, expert: Row | None) -> str:
    """Distance by that of the expert, with its own chance taken into account."""
    if expert is None:
        return NOTHING
    figures = row.per_drive(_distance)
    found = ratio(figures, expert.per_drive(_distance))
    return NOTHING if found is None else str(found)


def recall_ratio(row: Row, expert: Row | None) -> str:
    """Branch recall by the mean of all walks of the expert, as one of them is a matter of chance."""
    walks = None if expert is None else expert.per_agent(lambda it: it.choices.recall)
    if walks is None or not walks.any():
        return NOTHING
    whole = float(walks.mean())
    return agent_cell(row, lambda it: it.choices.recall / whole)


def _long_recall(row: Row) -> str:
    """By those agents whose drives and long drive are long enough together."""
    text = agent_cell(row, lambda it: recall_by(it, LONG_SECONDS))
    return "not driven" if text == NOTHING else text
