"""Rows of the suite in words and numbers, as the terminal and BENCHMARKS.md both show them."""

from typing import NamedTuple

from mjdrive.benchmarks.comparison import Comparison, Figure, NotMeasured, Reads, Row

_TIMES = ((1.0, 1.0, "s"), (1e-3, 1e3, "ms"), (0.0, 1e6, "us"))
"""Smallest number of seconds [s], factor and unit in which times are shown."""


class Line(NamedTuple):
    """One row in words.

    Attributes:
        name: What was measured.
        ours: Our side and what it took.
        theirs: The other side and what it took; empty where there is none.
        result: The ratio, or the figure.
        bar: What is asked.
        holds: Whether it is reached; None if it was not measured, or nothing is asked.
        note: What a reader should know.
    """

    name: str
    ours: str
    theirs: str
    result: str
    bar: str
    holds: bool | None
    note: str


def line(row: Row) -> Line:
    """Put one row in words."""
    if isinstance(row, Comparison):
        return _comparison(row)
    if isinstance(row, Figure):
        return _figure(row)
    return _missing(row)


def _comparison(row: Comparison) -> Line:
    low, median, high = row.ratio
    per = f" a {row.piece}"
    return Line(
        name=row.name,
        ours=f"{row.ours}: {amount(row.our_piece, row.unit)}{per}",
        theirs=f"{row.theirs}: {amount(row.their_piece, row.unit)}{per}",
        result=f"{number(median)}x {_reading(row.reads)} ({number(low)} to {number(high)})",
        bar=f"at {'most' if row.reads is Reads.COST else 'least'} {number(row.bar)}x",
        holds=row.holds,
        note=row.note,
    )


def _figure(row: Figure) -> Line:
    low, median, high = row.value
    limits = [f"at least {number(row.least)} {row.unit}"] if row.least is not None else []
    limits += [f"at most {number(row.most)} {row.unit}"] if row.most is not None else []
    between = "" if low == high else f" ({number(low)} to {number(high)})"
    return Line(
        name=row.name,
        ours=row.work,
        theirs="",
        result=f"{number(median)} {row.unit}{between}",
        bar=", ".join(limits),
        holds=row.holds if limits else None,
        note=row.note,
    )


def _missing(row: NotMeasured) -> Line:
    note = f"{row.reason} Makes it possible: {row.command}"
    return Line(row.name, row.work, "", "not measured", "", None, note)


def _reading(reads: Reads) -> str:
    return "as long" if reads is Reads.COST else reads.value


def amount(value: float, unit: str) -> str:
    """Write a quantity; seconds in the unit that suits them."""
    if unit != "s":
        return f"{number(value)} {unit}"
    for least, factor, name in _TIMES:
        if value >= least:
            return f"{number(factor * value)} {name}"
    return f"{number(value)} s"


def number(value: float) -> str:
    """Write a number with three digits that count."""
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:.3g}" if abs(value) >= 1e-3 or value == 0 else f"{value:.1e}"
