"""Tables about cars."""

import math
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from mjdrive.manoeuvres.bars import Bar, failed
from mjdrive.manoeuvres.comparison import Comparison
from mjdrive.manoeuvres.suite import Report

SMALLEST = 5e-5
"""What is smaller is shown as 0."""


def bars_table(report: Report, files: Sequence[Path]) -> None:
    """Print every figure, its limits and whether it holds.

    Args:
        report: What was measured.
        files: What was written, to be named below the table.
    """
    console = Console()
    title = f"{report.car.name}, {report.car.parameters.mass:,.0f} kg, {report.car.path.name}"
    table = Table(title=Text(title), title_justify="left", header_style="bold")
    for heading in ("figure", "measured", "bar", "holds", "why"):
        table.add_column(heading, justify="right" if heading == "measured" else "left")
    for name, group in groupby(report.bars, key=lambda bar: bar.manoeuvre):
        table.add_row(Text(name, style="bold"))
        for bar in group:
            mark = Text("yes", style="green") if bar.holds else Text("NO", style="bold red")
            table.add_row(
                Text(f"  {bar.figure}"), number(bar.measured, bar.unit), limits(bar), mark,
                Text(bar.reason),
            )  # fmt: skip
    console.print(table)
    broken = failed(report.bars)
    verdict = f"{len(report.bars) - len(broken)} of {len(report.bars)} bars hold."
    console.print(Text(verdict, style="bold red" if broken else "bold green"))
    for path in files:
        console.print(Text(str(path)), soft_wrap=True)


def comparison_table(comparison: Comparison) -> None:
    """Print the figures of a car and its models, a column each."""
    columns = {name: it.figures() for name, it in comparison.behaviours.items()}
    table = Table(title=Text(comparison.title), title_justify="left", header_style="bold")
    table.add_column("figure", no_wrap=True)
    for name in columns:
        table.add_column(Text(name), justify="right")
    first = next(iter(columns.values()))
    for figure, (unit, _) in first.items():
        values = [number(column[figure][1], "") for column in columns.values()]
        table.add_row(Text(f"{figure} [{unit}]"), *values)
    Console().print(table)


def say_missing(package: str, model: str) -> None:
    """Say what was left out because a package is not installed.

    Args:
        package: Its name on the index.
        model: What needs it.
    """
    Console().print(
        Text(f"{model} is not shown: the package '{package}' is not installed. Install it with: pip install {package}"),
        soft_wrap=True,
    )  # fmt: skip


def limits(bar: Bar) -> str:
    """The limits of a bar in words."""
    if bar.least is not None and bar.most is not None:
        return f"{number(bar.least, '')} to {number(bar.most, bar.unit)}"
    if bar.most is not None:
        return f"at most {number(bar.most, bar.unit)}"
    return "any" if bar.least is None else f"at least {number(bar.least, bar.unit)}"


def number(value: float, unit: str) -> str:
    """Three digits that matter, and the unit; a dash for what is no number."""
    if not math.isfinite(value):
        return "-"
    if value == round(value) or abs(value) < SMALLEST:
        text = f"{value:,.0f}".replace("-0", "0")
    else:
        decimals = max(2 - math.floor(math.log10(abs(value))), 0)
        text = f"{value:,.{min(decimals, 4)}f}"
    return f"{text} {unit}".rstrip()
