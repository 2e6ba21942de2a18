"""The tables of a study, in Markdown, made from its JSON files alone."""

from pathlib import Path

from mjdrive.config import StudyConfig, read_json
from mjdrive.files import write_atomically
from mjdrive.study.records.results import RESULTS, STUDY, StudyRecord, StudyResults
from mjdrive.study.tables.ablation_table import ablation_table
from mjdrive.study.tables.multimodality_table import multimodality_table
from mjdrive.study.tables.paper_table import paper_table
from mjdrive.study.tables.ratio_table import ratio_table
from mjdrive.study.tables.rows import markdown, turn_balance
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
    for name, text in study_tables(config, found).items():
        write_atomically(folder / TABLES / name, text.encode())


def study_tables(config: StudyConfig, found: StudyResults) -> dict[str, str]:
    """All tables of a study in Markdown, by their files.

    Args:
        config: Settings of the study.
        found: Its results.
    """
    return {
        SUMMARY: summary_table(config, found),
        PAPER: paper_table(config, found),
        MULTIMODALITY: multimodality_table(config, found),
        RATIOS: ratio_table(config, found),
        ABLATIONS: ablation_table(config, found),
        DATA: data_table(found),
    }


def data_table(found: StudyResults) -> str:
    """What was learnt from, and how often it turns which way."""
    head = ["demonstrations", "town", "drives", "samples", "left / straight / right", "manifest"]
    body = [
        [
            it.name,
            it.town,
            str(it.episodes),
            f"{it.samples:,}",
            turn_balance(it.choices.turn_shares),
            it.manifest_sha256[:12],
        ]
        for it in found.data
    ]
    return markdown(head, body)
