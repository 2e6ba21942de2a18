"""Tables about benchmarks."""

from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from mjdrive.benchmarks.suite import SUITE, Report
from mjdrive.benchmarks.wording import Line, line

_MARKS = {
    True: Text("yes", style="green"),
    False: Text("NO", style="bold red"),
    None: Text("-", style="dim"),
}


def names_table() -> None:
    """Print the names that `--only` takes."""
    table = Table(header_style="bold")
    for heading in ("name", "what is measured"):
        table.add_column(heading)
    for benchmark in SUITE:
        table.add_row(Text(benchmark.name, style="bold"), Text(benchmark.work))
    Console().print(table)


def report_table(report: Report, files: list[Path]) -> None:
    """Print every row, its bar and whether it holds.

    Args:
        report: What was measured.
        files: What was written, to be named below the table.
    """
    console = Console()
    where = report.machine
    title = f"{where.processor}, {where.num_cores} cores, load {where.load:.1f} at the start"
    table = Table(title=Text(title), title_justify="left", header_style="bold")
    for heading in ("measured", "ours", "theirs", "result", "bar", "holds"):
        table.add_column(heading)
    lines = [line(row) for row in report.all_rows]
    for shown in lines:
        words = (shown.ours, shown.theirs, shown.result, shown.bar)
        table.add_row(Text(shown.name, style="bold"), *map(Text, words), _MARKS[shown.holds])
    console.print(table)
    for shown in lines:
        if shown.note:
            console.print(Text(f"{shown.name}: {shown.note}"), soft_wrap=True)
    if report.neighbours:
        console.print(Text(report.neighbours), soft_wrap=True)
    console.print(_verdict(report, lines))
    for path in files:
        console.print(Text(str(path)), soft_wrap=True)


def _verdict(report: Report, lines: list[Line]) -> Text:
    """Count what holds; a quick look is no evidence."""
    judged = [shown.holds for shown in lines if shown.holds is not None]
    missing = sum(shown.result == "not measured" for shown in lines)
    words = f"{sum(judged)} of {len(judged)} bars hold, {missing} rows not measured, {sum(report.seconds.values()):.0f} s."
    if report.is_quick:
        words += " A quick look: too few rounds to be quoted."
    return Text(words, style="bold green" if all(judged) else "bold red")
