"""Tables about policies."""

from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from mjdrive.zoo import entries
from mjdrive.zoo.cards import ModelCard, read_card

_FIGURES = {
    "distance_m": "distance [m]",
    "red_lights": "red lights",
    "collisions": "collisions",
    "off_road_s": "off road [s]",
    "score": "score",
}
"""Figures of a drive that tell most."""


def shipped_table(zoo: Path) -> None:
    """Print one line for each policy that comes with mjdrive: what it is and how it drives.

    Args:
        zoo: Folder of the entries.
    """
    table = Table(box=None, header_style="bold", caption_justify="left")
    table.add_column("policy", no_wrap=True)
    for heading in ("drives", *_FIGURES.values(), "branches"):
        table.add_column(heading, justify="right")
    cards = [read_card(entries.find(name, zoo)) for name in entries.full_names(zoo)]
    for card in cards:
        table.add_row(entries.PREFIX + card.name, *_cells(card))
    console = Console()
    console.print(table)
    console.print(
        Text(
            f"Means over the drives, one after the other in each card: {zoo}/<name>/README.md",
            style="dim",
        )
    )


def _cells(card: ModelCard) -> list[str]:
    """How a policy drove when it was first evaluated."""
    if not card.evaluations:
        return ["not measured"]
    evaluation = card.evaluations[0]
    summary = evaluation.summary
    return [
        f"{summary.episodes} x {evaluation.steps:,} steps, {summary.town}",
        *(str(summary.figures[name]) for name in _FIGURES),
        f"{len(summary.branches_taken)} of {summary.branches}",
    ]
