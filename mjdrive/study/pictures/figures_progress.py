"""Training progress: how well agents drive while they learn, mean and spread over training seeds (the paper's figure)."""

from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from mjdrive.picture_style import STYLE, save
from mjdrive.study.pictures.figure_looks import GRID, Look
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.results import ProgressPoint

Figures = Sequence[DriveFigures]


def draw_progress(
    progress: Sequence[ProgressPoint],
    looks: Mapping[str, Look],
    branches: int,
    path: Path,
) -> None:
    """Draw distance, penalty, score and branch recall against epochs, one colour a method.

    Lines are means over training seeds of the means over drives; bands are one standard deviation of the seeds.

    Args:
        progress: Agents before the end of their training, at least one.
        looks: Of each arm, by name.
        branches: Ways through junctions that the town has [-].
        path: PNG file to write.
    """
    duration = progress[0].drives[0].duration_s
    panels: dict[str, Callable[[Figures], float]] = {
        f"distance in {duration:,.0f} s [m]": lambda drives: _mean(drives, "distance_m"),
        "infraction penalty $0.7^n$ [-]": lambda drives: _mean(drives, "penalty"),
        "score, distance times penalty [m]": lambda drives: _mean(drives, "score"),
        "branch recall [-]": lambda drives: _recall(drives, branches),
    }
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(8.5, 5.6), layout="constrained")
        grid = figure.subplots(2, 2, sharex=True)
        for axes, (label, figure_of) in zip(grid.flat, panels.items(), strict=True):
            for arm in dict.fromkeys(point.arm for point in progress):
                _draw_curve(axes, _table(progress, arm, figure_of), looks[arm])
            axes.set(ylabel=label)
            axes.set_ylim(0.0, 1.03 if axes in (grid[0, 1], grid[1, 1]) else None)
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
            axes.grid(color=GRID, linewidth=0.6)
            axes.set_axisbelow(True)
        for axes in grid[-1]:
            axes.set_xlabel("epoch")
        figure.legend(
            *grid[0, 0].get_legend_handles_labels(),
            loc="outside upper center",
            ncols=4,
            frameon=False,
        )
        save(figure, path)


def seeds_in_words(progress: Sequence[ProgressPoint], looks: Mapping[str, Look]) -> str:
    """How many training seeds each point has; empty if all have as many.

    Args:
        progress: Agents before the end of their training, at least one.
        looks: Of each arm, by name.
    """
    seeds = Counter((point.arm, point.epoch) for point in progress)
    if len(set(seeds.values())) == 1:
        return ""
    parts = []
    for arm in dict.fromkeys(point.arm for point in progress):
        epochs = defaultdict(list)
        for (name, epoch), count in sorted(seeds.items()):
            if name == arm:
                epochs[count].append(str(epoch))
        counts = [
            f"{count}" if len(epochs) == 1 else f"{count} at epoch {', '.join(each)}"
            for count, each in epochs.items()
        ]
        parts.append(f"{looks[arm].label} {' and '.join(counts)}")
    return f"Training seeds of each point: {'; '.join(parts)}."


def _table(
    progress: Sequence[ProgressPoint], arm: str, figure_of: Callable[[Figures], float]
) -> dict[int, list[float]]:
    """One figure of every seed, by epoch."""
    found = defaultdict(list)
    for point in progress:
        if point.arm == arm:
            found[point.epoch].append(figure_of(point.drives))
    return dict(sorted(found.items()))


def _draw_curve(axes: Axes, values: Mapping[int, Sequence[float]], look: Look) -> None:
    epochs = np.array(list(values))
    means = np.array([np.mean(row) for row in values.values()])
    spread = np.array([np.std(row, ddof=1) if len(row) > 1 else 0.0 for row in values.values()])
    axes.fill_between(
        epochs, np.maximum(means - spread, 0.0), means + spread, color=look.colour, alpha=0.12, lw=0
    )
    axes.plot(epochs, means, color=look.colour, marker="o", ms=3.0, lw=1.6, label=look.label)


def _mean(drives: Figures, name: str) -> float:
    return float(np.mean([getattr(drive, name) for drive in drives]))


def _recall(drives: Figures, branches: int) -> float:
    """Ways taken in any of the drives over all that there are [-]."""
    taken = {name for drive in drives for name, count in drive.branches_taken.items() if count}
    return len(taken) / branches if branches else 0.0
