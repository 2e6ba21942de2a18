"""Multimodality in pictures: what is seen of a town in time, and how often agents turn which way beside the expert."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mjdrive.picture_style import STYLE, save
from mjdrive.study.pictures.figure_looks import GRID, INK, PALE, Look
from mjdrive.study.records.measures import Curve
from mjdrive.study.records.results import ArmResult

MOVES = {"left": "#4c9be8", "straight": "#58aa58", "right": "#f08c32"}
"""Colour of each way through a junction, as on pictures of towns."""

MARKED = 3000.0
"""Branch recall is judged after so long [s]: ten of the paper's episodes."""

BASELINE = "expert"
"""Whose shares the others are compared with."""


def draw_recall(results: Sequence[ArmResult], looks: Mapping[str, Look], path: Path) -> None:
    """Draw branch recall over time, and lanes visited over distance: mean over seeds, and each seed faintly; then those that drove on.

    Args:
        results: Arms and references, at least one.
        looks: Of each of them, by name.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(8.5, 4.4), layout="constrained")
        recall, coverage = figure.subplots(1, 2)
        _draw_curves(recall, results, looks, lambda result: result.recall)
        _draw_curves(coverage, results, looks, lambda result: result.all_coverage)
        if recall.get_xlim()[1] > MARKED:
            recall.axvline(MARKED, color=PALE, linewidth=1.0, linestyle=":")
            recall.text(1.02 * MARKED, 0.02, f"{MARKED:,.0f} s", color=PALE, fontsize=8)
        recall.set(xlabel="time driven [s]", ylabel="branch recall [-]")
        coverage.set(xlabel="distance driven [km]", ylabel="share of lanes visited [-]")
        handles, labels = recall.get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=8
        )
        save(figure, path)


def draw_turns(shares: Mapping[str, Mapping[str, float]], path: Path) -> None:
    """Draw how often each arm turned left, went straight on and turned right, one bar an arm.

    Args:
        shares: By label, the share of each move, "left", "straight" and "right" [-]; the expert first, whose shares are
            drawn on through all bars.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(8.5, 0.9 + 0.32 * len(shares)), layout="constrained")
        axes = figure.add_subplot()
        for row, made in enumerate(shares.values()):
            start = 0.0
            for move, colour in MOVES.items():
                share = made.get(move, 0.0)
                axes.barh(
                    row, share, left=start, height=0.72, color=colour, label=move if not row else ""
                )
                if share >= 0.05:
                    axes.text(
                        start + share / 2, row, f"{100 * share:.0f} %", ha="center", va="center",
                        fontsize=8, color="white", weight="bold",
                    )  # fmt: skip
                start += share
        first = next(iter(shares.values()))
        edges = np.cumsum([first.get(move, 0.0) for move in MOVES])[:-1]
        axes.vlines(edges, -0.5, len(shares) - 0.5, color=INK, linewidth=1.0, linestyle=(0, (4, 2)))
        axes.set(yticks=range(len(shares)), yticklabels=list(shares), xlim=(0.0, 1.0))
        axes.set(ylim=(len(shares) - 0.5, -0.5), xlabel="share of all choices at junctions [-]")
        axes.spines[:].set_visible(False)
        axes.tick_params(length=0)
        figure.legend(loc="outside upper center", ncols=3, frameon=False)
        save(figure, path)


def turn_shares(
    results: Sequence[ArmResult], looks: Mapping[str, Look]
) -> dict[str, dict[str, float]]:
    """Mean turn shares over the seeds of each arm that came to a junction, by label; the expert first."""
    by_arm = {result.arm: [] for result in results}  # type: dict[str, list[Mapping[str, float]]]
    for result in results:
        if result.choices.passes:
            by_arm[result.arm].append(result.choices.turn_shares)
    order = sorted(by_arm, key=lambda arm: arm != BASELINE)
    return {
        looks[arm].label: {
            move: float(np.mean([shares.get(move, 0.0) for shares in by_arm[arm]]))
            for move in MOVES
        }
        for arm in order
        if by_arm[arm]
    }


def at(curve: Curve, x: np.ndarray) -> np.ndarray:
    """The share of a curve that grows in steps, at some x [-]."""
    index = np.searchsorted(np.array(curve.x), x, side="right") - 1
    return np.where(index >= 0, np.array(curve.share)[np.maximum(index, 0)], 0.0)


def _draw_curves(
    axes: Axes,
    results: Sequence[ArmResult],
    looks: Mapping[str, Look],
    curve_of: Callable[[ArmResult], Curve],
) -> None:
    for arm in dict.fromkeys(result.arm for result in results):
        curves = [curve_of(result) for result in results if result.arm == arm]
        look = looks[arm]
        style = {"color": look.colour, "linestyle": look.line_style}
        # As far as all seeds were driven, so that a mean never rests on fewer of them.
        end = min(curve.x[-1] for curve in curves)
        x = np.linspace(0.0, end, 400)
        axes.plot(
            x,
            np.mean([at(curve, x) for curve in curves], axis=0),
            lw=1.6,
            label=look.label,
            **style,
        )
        for curve in curves if len(curves) > 1 else ():
            axes.plot(x, at(curve, x), alpha=0.25, lw=0.8, **style)
            beyond = np.linspace(end, curve.x[-1], 400)  # where one seed drove on by itself
            axes.plot(beyond, at(curve, beyond), alpha=0.7, lw=1.0, **style)
    axes.set(ylim=(0.0, 1.02), xlim=(0.0, None))
    axes.grid(color=GRID, linewidth=0.6)
