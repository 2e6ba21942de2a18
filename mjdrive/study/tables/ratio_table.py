"""The result to reach: policies against the expert in the same time and town, beside the bars that were set."""

from collections.abc import Callable

from mjdrive.config import StudyConfig
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.tables.arm_figures import recall_by, total
from mjdrive.study.tables.rows import (
    NOTHING,
    Row,
    agent_cell,
    arm_rows,
    cell,
    expert_row,
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
    "JS of exits, seeds pooled [bit]": (NOTHING, NOTHING, NOTHING),
    "its floor [bit]": (NOTHING, NOTHING, NOTHING),
    "JS of turns [bit]": (NOTHING, "0.05", "0.02"),
    "collisions per 3,000 s": ("no crashes", "0.5", "0"),
    "off road [s] per 3,000 s": (NOTHING, "5", "0"),
}
"""What the paper says of its DA-IBC, the bar and the goal, by column."""

EPISODE_STEPS, ALL_STEPS = 3000, 30_000
"""Control steps of an episode, and of all of an agent, that these are set for [-]."""

LONG_SECONDS = 10_000.0
"""Time that a policy should have seen the whole town in, drives and long drive together [s]."""

REFERENCE_SECONDS = 3000.0
"""Time that collisions and time off the road are counted over [s]."""


def ratio_table(config: StudyConfig, found: StudyResults) -> str:
    """Each policy beside the bars, with bootstrap intervals over seeds and episodes.

    Distances are compared with the expert's own chance taken into account. Recall is a figure of all drives of an agent
    together, so that its interval is one over training seeds alone. The bars are left out where they do not hold, as they
    are set for ten episodes of 300 s.

    Args:
        config: Settings of the study.
        found: Its results.
    """
    expert = expert_row(found)
    rows = [*reference_rows(found), *(it for it in arm_rows(config, found) if not it.change)]
    measured = [[row.label, training_seeds(row), *_cells(row, expert, found)] for row in rows]
    is_theirs = (config.steps, config.episodes * config.steps) == (EPISODE_STEPS, ALL_STEPS)
    return markdown(["", "training seeds", *BARS], [*(_bars() if is_theirs else ()), *measured])


def _bars() -> list[list[str]]:
    columns = ("paper's DA-IBC", "bar", "goal")
    return [
        [name, NOTHING, *(values[index] for values in BARS.values())]
        for index, name in enumerate(columns)
    ]


def _cells(row: Row, expert: Row | None, found: StudyResults) -> list[str]:
    together = found.pooled.get(row.results[0].arm)
    return [
        cell(row.per_drive(_penalty)),
        distance_ratio(row, expert),
        recall_ratio(row, expert),
        _long_recall(row),
        number(together.divergence if together else None, digits=3),
        number(together.divergence_floor if together else None, digits=3),
        agent_cell(row, lambda it: it.choices.turn_divergence, digits=3),
        cell(row.per_agent(lambda it: _per_time(it, lambda drive: drive.collisions))),
        cell(row.per_agent(lambda it: _per_time(it, lambda drive: drive.off_road_s))),
    ]


def _penalty(drive: DriveFigures) -> float:
    return drive.penalty


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
    return cell(row.per_agent(lambda it: it.choices.recall / whole))


def _long_recall(row: Row) -> str:
    """By those agents whose drives and long drive are long enough together."""
    text = agent_cell(row, lambda it: recall_by(it, LONG_SECONDS))
    return "not driven" if text == NOTHING else text


def _per_time(result: ArmResult, figure: Callable[[DriveFigures], float]) -> float:
    """A figure in the time that bars are set for."""
    return total(figure)(result) * REFERENCE_SECONDS / total(lambda it: it.duration_s)(result)
