"""The tables of a study, in Markdown, made from its JSON files alone."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from mjdrive.config import StudyConfig, read_json
from mjdrive.files import write_atomically
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.results import RESULTS, STUDY, ArmResult, StudyRecord, StudyResults
from mjdrive.study.tables.ablation_table import ablation_table
from mjdrive.study.tables.arm_figures import (
    conditional_entropy,
    exits_taken,
    held_out_gain,
    junction_entropy,
    junction_gain,
    km_to_half,
    km_to_half_in_all,
    long_score,
    mode_precision,
    num_modes,
    reds_per_km,
    reds_per_light,
    total,
)
from mjdrive.study.tables.ratio_table import ratio_table
from mjdrive.study.tables.rows import (
    NOTHING,
    Column,
    Row,
    agent_cell,
    arm_rows,
    cell,
    markdown,
    reference_rows,
    training_seeds,
)
from mjdrive.study.tables.summary_table import summary_table

TABLES = "tables"
"""Folder of the tables."""

SUMMARY, PAPER, MULTIMODALITY, RATIOS, ABLATIONS, DATA = (
    "summary.md",
    "paper.md",
    "multimodality.md",
    "ratios.md",
    "ablations.md",
    "demonstrations.md",
)


def write_tables(folder: Path) -> None:
    """Write all tables of a study beside its results.

    Args:
        folder: Of the study.

    Raises:
        ConfigError: If its JSON files are missing or damaged.
    """
    config = read_json(StudyRecord, folder / STUDY).settings
    found = read_json(StudyResults, folder / RESULTS)
    for name, text in {
        SUMMARY: summary_table(config, found),
        PAPER: paper_table(config, found),
        MULTIMODALITY: multimodality_table(config, found),
        RATIOS: ratio_table(config, found),
        ABLATIONS: ablation_table(config, found),
        DATA: data_table(found),
    }.items():
        write_atomically(folder / TABLES / name, text.encode())


def paper_table(config: StudyConfig, found: StudyResults) -> str:
    """Distance, infraction penalty and score, as the paper counts them, and what else went wrong."""
    episode, all_drives = duration(config.steps), duration(config.steps * config.episodes)
    columns: tuple[Column, ...] = (
        (f"distance [m] per {episode}", _drive(lambda it: it.distance_m)),
        (f"penalty 0.7^n per {episode}", _drive(lambda it: it.penalty)),
        (f"score [m] per {episode}", _drive(lambda it: it.score)),
        (f"score [m] per {all_drives}", _agent(long_score)),
        ("red lights per km", _agent(reds_per_km)),
        ("red lights run per light met", _agent(reds_per_light)),
        (f"collisions per {all_drives}", _summed(lambda it: it.collisions)),
        (f"off road [s] per {all_drives}", _summed(lambda it: it.off_road_s)),
        (f"stuck [s] per {all_drives}", _summed(lambda it: it.stuck_s)),
        ("jerk [m/s³]", _drive(lambda it: it.jerk_rms)),
        (
            "steering whiteness [1/s]",
            _drive(lambda it: it.steering_whiteness),
        ),
    )
    rows = [*reference_rows(found), *(it for it in arm_rows(config, found) if not it.change)]
    return _table(rows, columns)


def multimodality_table(config: StudyConfig, found: StudyResults) -> str:
    """What is chosen where the road forks, and how many ways to act a policy sees."""
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
        ("entropy at junctions [bit]", _agent(junction_entropy)),
        (
            "held-out log-likelihood above uniform [nats]",
            _agent(held_out_gain),
        ),
        (
            "the same at junctions [nats]",
            _agent(junction_gain),
        ),
    )
    rows = [*reference_rows(found), *(it for it in arm_rows(config, found) if not it.change)]
    return _table(rows, columns)


def data_table(found: StudyResults) -> str:
    """What was learnt from, and how often it turns which way."""
    head = ["demonstrations", "town", "drives", "samples", "left / straight / right", "manifest"]
    body = [
        [
            it.name,
            it.town,
            str(it.episodes),
            f"{it.samples:,}",
            _shares(it.choices.turn_shares),
            it.manifest_sha256[:12],
        ]
        for it in found.data
    ]
    return markdown(head, body)


def turns(row: Row) -> str:
    """Shares of left, straight and right over all agents [%]."""
    passes = sum(it.choices.passes for it in row.results)
    if not passes:
        return NOTHING
    moves = {move for it in row.results for move in it.choices.turn_shares}
    return _shares(
        {
            move: sum(
                it.choices.turn_shares.get(move, 0.0) * it.choices.passes for it in row.results
            )
            / passes
            for move in moves
        }
    )


def duration(steps: int) -> str:
    """Simulated time of some control steps, in words."""
    return f"{0.1 * steps:,.0f} s"


def _shares(shares: Mapping[str, float]) -> str:
    return (
        " / ".join(f"{100 * shares.get(move, 0.0):.0f}" for move in ("left", "straight", "right"))
        + " %"
    )


def _summed(figure: Callable[[DriveFigures], float]) -> Callable[[Row], str]:
    return _agent(total(figure))


def _drive(figure: Callable[[DriveFigures], float]) -> Callable[[Row], str]:
    return lambda row: cell(row.per_drive(figure))


def _agent(figure: Callable[[ArmResult], float | None], *, digits: int = 2) -> Callable[[Row], str]:
    return lambda row: agent_cell(row, figure, digits=digits)


def _long(figure: Callable[[ArmResult], float | None]) -> Callable[[Row], str]:
    """A figure of those agents that made a long drive."""
    return _agent(lambda it: None if it.long_drive is None else figure(it))


def _table(rows: Sequence[Row], columns: Sequence[Column]) -> str:
    columns = (("training seeds", training_seeds), *columns)
    head = ["", *(title for title, _ in columns)]
    return markdown(head, [[row.label, *(show(row) for _, show in columns)] for row in rows])
