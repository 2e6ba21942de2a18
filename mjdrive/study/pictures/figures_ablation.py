"""The ablation picture: one row a change, dot and interval for each of the main figures."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill

import matplotlib.style
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from mjdrive.evaluation.bootstrap import Interval
from mjdrive.picture_style import STYLE, save
from mjdrive.study.pictures.figure_looks import GRID, INK, PALE

LABEL_WIDTH = 42
"""Letters in a line of the label of a row; longer labels have several lines."""

TITLE_WIDTH = 14
"""Letters in a line of the title of a figure."""


@dataclass(frozen=True, slots=True)
class AblationRow:
    """One way to learn or to act, with its main figures.

    Attributes:
        label: What was changed, in words.
        colour: Of its dots.
        intervals: One a figure, in the order of the columns; None where a figure is missing.
    """

    label: str
    colour: str
    intervals: tuple[Interval | None, ...]


def draw_ablation(
    columns: Sequence[str],
    groups: Sequence[Sequence[AblationRow]],
    path: Path,
    reference: AblationRow | None = None,
) -> None:
    """Draw groups of rows: the first row of each is what the others change, and its value is drawn on through them.

    Args:
        columns: Names of the figures with their units.
        groups: At least one group of at least one row.
        path: PNG file to write.
        reference: Stands below all groups, and its values are drawn on through all of them; None for none.
    """
    groups = [*groups, *([[reference]] if reference is not None else [])]
    rows = sum(len(group) for group in groups)
    with matplotlib.style.context(["default", STYLE]):
        size = (9.5, 1.0 + 0.31 * rows + 0.25 * len(groups))
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(1, len(columns), sharey=True, squeeze=False)[0]
        places = _places(groups)
        for index, (axes, column) in enumerate(zip(grid, columns, strict=True)):
            known = None if reference is None else reference.intervals[index]
            if known is not None:
                axes.axvline(known.value, color=PALE, lw=0.8, ls=(0, (5, 2)), zorder=0.5)
            for group, heights in zip(groups, places, strict=True):
                base = group[0].intervals[index]
                if base is not None:
                    axes.vlines(base.value, heights[-1] + 0.4, heights[0] - 0.4, color=INK, lw=0.7, ls=":")  # fmt: skip
                for row, height in zip(group, heights, strict=True):
                    found = row.intervals[index]
                    if found is not None:
                        axes.hlines(height, found.low, found.high, color=row.colour, lw=2.2, alpha=0.45)  # fmt: skip
                        axes.plot(found.value, height, "o", color=row.colour, ms=4.5)
            axes.set_title(fill(column, TITLE_WIDTH), fontsize=8.5)
            axes.grid(axis="x", color=GRID, linewidth=0.6)
            axes.tick_params(axis="y", length=0)
            axes.tick_params(axis="x", labelsize=7.5)
            axes.margins(x=0.08)
            axes.xaxis.set_major_locator(MaxNLocator(nbins=3))
            axes.spines["left"].set_visible(False)
        every = [row for group in groups for row in group]
        grid[0].set_yticks([height for heights in places for height in heights], [fill(it.label, LABEL_WIDTH) for it in every])  # fmt: skip
        firsts = {id(group[0]) for group in groups if group[0] is not reference}
        for text, row in zip(grid[0].get_yticklabels(), every, strict=True):
            text.set_fontweight("bold" if id(row) in firsts else "normal")
            text.set_fontsize(8)
        grid[0].set_ylim(places[-1][-1] + 0.6, places[0][0] - 0.6)
        save(figure, path)


def _places(groups: Sequence[Sequence[AblationRow]]) -> list[list[float]]:
    """Height of every row, falling, with a gap between two groups."""
    places, height = [], 0.0
    for group in groups:
        places.append([height + index for index in range(len(group))])
        height += len(group) + 0.7
    return places
