"""Write the tables of docs/car.md and docs/cars.md from what `mjdrive car test` and `mjdrive car compare` have measured.

Before: `mjdrive car test --plot --out docs/car`, `mjdrive car test --car mkz --out docs/car_mkz` and `mjdrive car
compare --out docs/car_compared`.
"""

import json
from itertools import groupby
from pathlib import Path
from typing import Any

from mjdrive.cli.car_tables import limits, number
from mjdrive.manoeuvres.bars import Bar

ROOT = Path(__file__).resolve().parents[1]
CARD = ROOT / "docs" / "car.md"
PAGE = ROOT / "docs" / "cars.md"
MKZ_REPORT = ROOT / "docs" / "car_mkz" / "report.json"
REPORT = ROOT / "docs" / "car" / "report.json"
COMPARISON = ROOT / "docs" / "car_compared" / "comparison.json"


def bars_of(report: dict[str, Any]) -> list[Bar]:
    """The bars that a report holds."""
    names = ("manoeuvre", "figure", "measured", "unit", "least", "most", "reason")
    return [Bar(**{name: row[name] for name in names}) for row in report["bars"]]


def measured_table(report: Path) -> str:
    """Every figure of a report as a table in Markdown."""
    rows = ["| figure | measured | bar | where it comes from |", "|---|---|---|---|"]
    bars = bars_of(json.loads(report.read_text()))
    for manoeuvre, group in groupby(bars, key=lambda bar: bar.manoeuvre):
        rows.append(f"| **{manoeuvre}** | | | |")
        rows += [
            f"| {bar.figure} | {number(bar.measured, bar.unit)} | {limits(bar)} | {bar.reason} |"
            for bar in group
        ]
    return "\n".join(rows)


def compared_table() -> str:
    """Every comparison as a table in Markdown."""
    parts = []
    for title, models in json.loads(COMPARISON.read_text()).items():
        rows = [f"| {title} | {' | '.join(models)} |", "|---|" + "---|" * len(models)]
        for figure, first in next(iter(models.values())).items():
            values = [model[figure]["value"] for model in models.values()]
            cells = ["-" if value is None else number(value, "") for value in values]
            rows.append(f"| {figure} [{first['unit']}] | {' | '.join(cells)} |")
        parts.append("\n".join(rows))
    return "\n\n".join(parts)


def with_tables(text: str) -> str:
    """Put the tables between their marks in a page, those that it has."""
    tables = {
        "measured": measured_table(REPORT),
        "measured mkz": measured_table(MKZ_REPORT),
        "compared": compared_table(),
    }
    for mark, table in tables.items():
        begin, end = f"<!-- {mark}: begin -->\n", f"<!-- {mark}: end -->"
        if begin not in text:
            continue
        head, _, rest = text.partition(begin)
        _, _, tail = rest.partition(end)
        text = f"{head}{begin}{table}\n{end}{tail}"
    return text


if __name__ == "__main__":
    for page in (CARD, PAGE):
        page.write_text(with_tables(page.read_text()))
