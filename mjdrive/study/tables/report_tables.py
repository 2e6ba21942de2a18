"""Tables of a study from Markdown to what a page shows."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Table:
    """A table as text.

    Attributes:
        head: Titles of the columns.
        body: Rows, as many cells each.
    """

    head: tuple[str, ...]
    body: tuple[tuple[str, ...], ...]


def read_markdown(text: str) -> Table | None:
    """Read the first table of a Markdown text.

    Args:
        text: Lines of the form "| cell | cell |", the second of them dashes; other lines are passed over.

    Returns:
        The table, or None if there is none.
    """
    lines = [line.strip() for line in text.splitlines()]
    rows = [_cells(line) for line in lines if line.startswith("|") and line.endswith("|")]
    if len(rows) < 2:
        return None
    head, _, *body = rows
    return Table(head, tuple(body))


def _cells(line: str) -> tuple[str, ...]:
    return tuple(cell.strip() for cell in line[1:-1].split("|"))
