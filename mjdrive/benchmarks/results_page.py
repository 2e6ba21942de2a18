"""Results as a page to read: written between two marks of a Markdown file, with a picture beside it."""

from pathlib import Path

from mjdrive.benchmarks.results_figure import draw
from mjdrive.benchmarks.suite import Report
from mjdrive.benchmarks.wording import Line, line
from mjdrive.errors import DataError
from mjdrive.files import write_atomically

BEGIN = "<!-- results: written by `mjdrive bench --markdown` -->"
END = "<!-- end of results -->"
PICTURE = Path("docs", "benchmarks.png")

_MARKS = {True: "yes", False: "**no**", None: ""}


def write_page(report: Report, page: Path) -> list[Path]:
    """Put results into a page; what stands outside the marks stays.

    Args:
        report: What was measured.
        page: Markdown file with a line `BEGIN` and a line `END`.

    Returns:
        The files that were written.

    Raises:
        DataError: If the file is missing or lacks a mark.
    """
    before, after = around_results(page)
    picture = page.parent / PICTURE
    draw(report, picture)
    write_atomically(page, f"{before}{BEGIN}\n{results(report)}{END}{after}".encode())
    return [page, picture]


def around_results(page: Path) -> tuple[str, str]:
    """What stands before the first mark of a page and after the second.

    Args:
        page: Markdown file with a line `BEGIN` and a line `END`.

    Raises:
        DataError: If the file is missing or lacks a mark.
    """
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise DataError(
            f"Cannot write results into '{page}'; expected a file with a line '{BEGIN}' and a line '{END}' after it. "
            f"BENCHMARKS.md of a checkout is one."
        )
    return before, after


def results(report: Report) -> str:
    """Write machine, table and notes in Markdown."""
    lines = [line(row) for row in report.all_rows]
    where = report.machine
    versions = ", ".join(f"{name} {version}" for name, version in where.versions.items())
    memory = f"{where.memory_gb:.0f} GB" if where.memory_gb > 0 else "memory unknown"
    look = " **A quick look: too few rounds to be quoted.**" if report.is_quick else ""
    return "\n".join(
        [
            "",
            f"Measured on {where.processor}, {where.num_cores} cores, {memory}, {where.system}, "
            f"load {where.load:.1f} at the start, in {sum(report.seconds.values()) / 60:.0f} minutes. {versions}.{look}",
            "",
            *_surroundings(report),
            f"![Ratios against their bars]({PICTURE.as_posix()})",
            "",
            "| measured | ours | theirs | result | bar | holds |",
            "|---|---|---|---|---|---|",
            *(_row(it) for it in lines),
            "",
            *(f"- {it.name}: {it.note}" for it in lines if it.note),
            "",
            "",
        ]
    )


def _surroundings(report: Report) -> list[str]:
    """What networks find on the machine, and what other programs took of it."""
    facts = ", ".join(f"{name} {value}" for name, value in report.machine.networks.items())
    sentences = ([f"Networks: {facts}."] if facts else []) + [report.neighbours]
    return [" ".join(filter(None, sentences)), ""] if any(sentences) else []


def _row(it: Line) -> str:
    cells = (it.name, it.ours, it.theirs, it.result, it.bar, _MARKS[it.holds])
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
