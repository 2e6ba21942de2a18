"""The table that a reader begins with: counts as they are, one for each agent, beside ratios to the expert."""

from collections.abc import Callable

from mjdrive.config import StudyConfig
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.tables.arm_figures import recall_by, total
from mjdrive.study.tables.ratio_table import LONG_SECONDS, distance_ratio, recall_ratio
from mjdrive.study.tables.rows import (
    NOTHING,
    Column,
    Row,
    agent_cell,
    arm_rows,
    expert_row,
    markdown,
    number,
    reference_rows,
)


def summary_table(config: StudyConfig, found: StudyResults) -> str:
    """What happened to each agent, in the order of training seeds, and of the expert's walks.

    Counts are small, so they stand there themselves and not as means. Distances have bootstrap intervals over agents and
    drives; ways and the divergence of turns over agents alone, as in `ratio_table`.

    Args:
        config: Settings of the study.
        found: Its results.
    """
    rows = [*(it for it in arm_rows(config, found) if not it.change), *reference_rows(found)]
    shown = [
        *summary_columns(found),
        (f"ways in {LONG_SECONDS:,.0f} s", _long_ways),
    ]
    head = ["", *(title for title, _ in shown)]
    return markdown(head, [[row.label, *(show(row) for _, show in shown)] for row in rows])


def summary_columns(found: StudyResults) -> tuple[Column, ...]:
    """What happened in the drives of a row, and which ways it took."""
    expert = expert_row(found)
    return (
        ("distance / the expert's", lambda row: distance_ratio(row, expert)),
        ("red lights", _counts(total(lambda it: it.red_lights))),
        ("collisions", _counts(total(lambda it: it.collisions))),
        ("kerbs", _counts(total(lambda it: it.kerb_strikes))),
        ("against the traffic", _counts(total(lambda it: it.wrong_ways))),
        ("off the road [s]", _counts(total(lambda it: it.off_road_s))),
        (f"ways of {_num_ways(found)}", _counts(lambda it: it.choices.taken)),
        ("ways / the expert's", lambda row: recall_ratio(row, expert)),
        (
            "JS of turns [bit]",
            lambda row: agent_cell(row, lambda it: it.choices.turn_divergence, digits=3),
        ),
    )


def _counts(figure: Callable[[ArmResult], float]) -> Callable[[Row], str]:
    """A figure of each agent, once if it is the same."""

    def shown(row: Row) -> str:
        each = [_plain(figure(it)) for it in row.results]
        return f"{each[0]} each" if len(set(each)) == 1 < len(each) else ", ".join(each)

    return shown


def _plain(value: float | int) -> str:
    """A count, or a time without digits that say nothing."""
    tenths = round(value, 1)
    return f"{tenths:,.0f}" if tenths >= 10 or tenths == round(tenths) else f"{tenths:.1f}"


def _num_ways(found: StudyResults) -> int:
    return max(it.choices.branches for it in (*found.arms, *found.references))


def _long_ways(row: Row) -> str:
    """Of those agents that drove for so long, and how many those are unless all did."""
    shares = [(recall_by(it, LONG_SECONDS), it.choices.branches) for it in row.results]
    ways = [number(share * ways, digits=0) for share, ways in shares if share is not None]
    if not ways:
        return NOTHING
    few = f" ({len(ways)} of {len(row.results)})" if len(ways) < len(row.results) else ""
    return ", ".join(ways) + few
