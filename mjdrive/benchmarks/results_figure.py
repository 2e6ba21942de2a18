"""All ratios in one picture: how far beyond its bar each of them is."""

from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import FuncFormatter

from mjdrive.benchmarks.comparison import Comparison, Reads
from mjdrive.benchmarks.suite import Report
from mjdrive.benchmarks.wording import number
from mjdrive.picture_style import STYLE, save

HOLDS, FALLS_SHORT, BAR = "#2a7f62", "#c0492f", "#222222"


def draw(report: Report, path: Path) -> None:
    """Draw every ratio as a bar of its own, with its spread and what is asked.

    Args:
        report: What was measured.
        path: PNG file to write.
    """
    rows = [row for row in report.all_rows if isinstance(row, Comparison)]
    with matplotlib.style.context(["default", STYLE]):
        canvas = Canvas(figsize=(8.0, 1.2 + 0.42 * len(rows)), layout="constrained")
        axes = canvas.subplots()
        for place, row in enumerate(rows):
            low, median, high = row.ratio
            color = HOLDS if row.holds else FALLS_SHORT
            axes.barh(place, median - 1.0, left=1.0, height=0.55, color=color)
            axes.plot([low, high], [place, place], color=BAR, linewidth=1.0)
            axes.plot([row.bar, row.bar], [place - 0.4, place + 0.4], color=BAR, linewidth=2.0)
            axes.annotate(
                f"{number(median)}x",
                (max(median, row.bar, high), place),
                xytext=(6, 0),
                textcoords="offset points",
                va="center",
            )
        axes.set_yticks(np.arange(len(rows)), [_label(row) for row in rows])
        axes.invert_yaxis()
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}x"))
        axes.margins(x=0.12)
        axes.set_xlabel(
            "ratio of times or sizes, log scale; the black mark is the bar: green reaches it, red does not"
        )
        axes.set_title(f"mjdrive against the side named, {report.machine.processor}", loc="left")
        save(canvas, path)


def _label(row: Comparison) -> str:
    if row.reads is Reads.COST:
        return f"{row.name}\ntimes as long as without, at most"
    return f"{row.name}\n{row.reads.value}, at least"
