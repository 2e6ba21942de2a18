"""The table of multimodality: what is chosen where the road forks, and how many ways to act a policy sees."""

from collections.abc import Callable

from mjdrive.config import StudyConfig
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.tables.arm_figures import (
    conditional_entropy,
    exits_taken,
    heaviest_mode,
    held_out_gain,
    junction_entropy,
    junction_gain,
    km_to_half,
    km_to_half_in_all,
    mode_precision,
    num_modes,
    share_multimodal,
)
from mjdrive.study.tables.rows import (
    NOTHING,
    Column,
    Row,
    agent_cell,
    agents_table,
    duration,
    turn_balance,
)


def multimodality_table(config: StudyConfig, found: StudyResults) -> str:
    """What is chosen where the road forks, and how many ways to act a policy sees.

    All are figures of an agent, with bootstrap intervals over seeds alone: a way that was taken in one drive alone is
    missing in a third of all draws of its drives, so that a draw has taken fewer ways than the agent, and choices that are
    counted twice look less even, and further from the expert's, than they were.

    Args:
        config: Settings of the study.
        found: Its results.
    """
    all_drives = duration(config.steps * config.episodes)
    everything = (
        f"{duration(config.steps * config.episodes + config.long_steps)}, long drive included"
    )
    columns: tuple[Column, ...] = (
        (f"branch recall in {all_drives}", _agent(lambda it: it.choices.recall)),
        (f"branch recall in {everything}", _long(lambda it: it.all_choices.recall)),
        ("directed lanes visited", _agent(lambda it: it.coverage.share[-1])),
        (f"directed lanes visited in {everything}", _long(lambda it: it.all_coverage.share[-1])),
        ("km to half of them", _agent(km_to_half)),
        (f"km to half of them in {everything}", _long(km_to_half_in_all)),
        ("branch entropy", _agent(lambda it: it.choices.entropy)),
        (f"branch entropy in {everything}", _long(lambda it: it.all_choices.entropy)),
        ("JS to the expert's exits [bit]", _agent(lambda it: it.choices.divergence, digits=3)),
        ("its floor [bit]", _agent(lambda it: it.choices.divergence_floor, digits=3)),
        ("JS of turns [bit]", _agent(lambda it: it.choices.turn_divergence, digits=3)),
        ("left / straight / right", turns),
        ("mode precision", _agent(mode_precision)),
        ("exit taken", _agent(exits_taken)),
        ("conditional entropy", _agent(conditional_entropy)),
        ("modes at junctions", _agent(num_modes)),
        ("share of moments with several", _agent(share_multimodal, digits=3)),
        ("mass of the heaviest mode", _agent(heaviest_mode, digits=3)),
        ("entropy at junctions [bit]", _agent(junction_entropy)),
        ("held-out log-likelihood above uniform [nats]", _agent(held_out_gain)),
        ("the same at junctions [nats]", _agent(junction_gain)),
    )
    return agents_table(config, found, columns)


def turns(row: Row) -> str:
    """Shares of left, straight and right over all agents [%]."""
    passes = sum(it.choices.passes for it in row.results)
    if not passes:
        return NOTHING
    moves = {move for it in row.results for move in it.choices.turn_shares}
    return turn_balance(
        {
            move: sum(
                it.choices.turn_shares.get(move, 0.0) * it.choices.passes for it in row.results
            )
            / passes
            for move in moves
        }
    )


def _agent(figure: Callable[[ArmResult], float | None], *, digits: int = 2) -> Callable[[Row], str]:
    return lambda row: agent_cell(row, figure, digits=digits)


def _long(figure: Callable[[ArmResult], float | None]) -> Callable[[Row], str]:
    """A figure of those agents that made a long drive."""
    return _agent(lambda it: None if it.long_drive is None else figure(it))
