"""The table of ablations: what each change does, below what it changes."""

from mjdrive.config import StudyConfig
from mjdrive.study.records.results import StudyResults
from mjdrive.study.tables.arm_figures import junction_gain, mode_precision
from mjdrive.study.tables.rows import (
    Column,
    ablation_labels,
    agent_cell,
    markdown,
    reference_rows,
    same_seeds,
    training_seeds,
)
from mjdrive.study.tables.summary_table import summary_columns


def ablation_table(config: StudyConfig, found: StudyResults) -> str:
    """Single changes, each group below what it changes, and the references; all of a group are by the same training seeds.

    Args:
        config: Settings of the study.
        found: Its results.
    """
    columns: tuple[Column, ...] = (
        ("training seeds", training_seeds),
        *summary_columns(found),
        ("mode precision", lambda row: agent_cell(row, mode_precision)),
        ("held-out log-likelihood at junctions [nats]", lambda row: agent_cell(row, junction_gain)),
    )
    rows = [row for labels in ablation_labels(config) for _, row in same_seeds(found, labels)]
    if not rows:
        return "This study has no ablations.\n"
    body = [
        [row.label, *(show(row) for _, show in columns)] for row in (*rows, *reference_rows(found))
    ]
    return markdown(["", *(title for title, _ in columns)], body)
