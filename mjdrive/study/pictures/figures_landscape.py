"""Landscapes: what a policy thinks of every action, with what it sees above (the paper's figure, for any method)."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib.style
import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from mjdrive.evaluation.landscape import DEEPEST, energies, modes
from mjdrive.picture_style import STYLE, save

COLUMN, ROW, EDGE = 2.15, 2.15, 0.62
"""Width of a situation, height of a landscape, and space around [inch]."""

BESIDE = 0.4
"""Modes that are nearer to each other along both components would write over each other [-]."""

Panel = tuple[Float[np.ndarray, "A S"], Float[np.ndarray, "N 2"]]
"""Probabilities over the grid of actions, acceleration outermost, and actions drawn [-]."""


def draw_landscapes(
    titles: Sequence[str],
    views: Sequence[UInt8[np.ndarray, "H W 3"]],
    rows: Mapping[str, Sequence[Panel]],
    path: Path,
) -> None:
    """Draw situations from left to right: what is seen, and below it the landscape of each policy.

    Args:
        titles: Of each situation.
        views: Bird's-eye view of each situation, RGB.
        rows: By the label of a policy, its landscape in each situation.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        size = (COLUMN * len(titles) + 2 * EDGE, ROW * (1 + len(rows)) + EDGE)
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(1 + len(rows), len(titles), squeeze=False)
        for axes, title, view in zip(grid[0], titles, views, strict=True):
            axes.imshow(view, interpolation="antialiased")
            axes.set(title=title, xticks=[], yticks=[])
            axes.spines[:].set(visible=True, color="#d0d7de")
        for line, (label, panels) in zip(grid[1:], rows.items(), strict=True):
            for axes, panel in zip(line, panels, strict=True):
                image = draw_panel(axes, panel)
            line[0].set_ylabel(
                f"{label}\nacceleration [-]" if len(rows) > 1 else "acceleration [-]"
            )
        for axes in grid[-1]:
            axes.set_xlabel("steering [-], left is left")
        figure.colorbar(
            image,
            ax=grid[1:],
            label="energy above the lowest [nats]",
            shrink=0.9 if len(rows) == 1 else 0.5,
            extend="max",
            pad=0.015,
        )
        save(figure, path)


def draw_panel(axes: Axes, panel: Panel) -> AxesImage:
    """Draw one landscape: energy, zero-steering line, actions drawn, and modes with their mass.

    Args:
        axes: Where.
        panel: The landscape.

    Returns:
        The image, for a scale of colours.
    """
    probabilities, draws = panel
    half = 1.0 / (len(probabilities) - 1)  # of a cell
    image = axes.imshow(
        energies(probabilities),
        origin="lower",
        extent=(-1 - half, 1 + half, -1 - half, 1 + half),
        cmap="YlGnBu_r",
        vmin=0.0,
        vmax=DEEPEST,
        interpolation="nearest",
    )
    axes.axvline(0.0, color="#6e7781", linewidth=0.8)
    found = modes(probabilities)
    for mode in found:
        is_lower = any(
            abs(other.steering - mode.steering) < BESIDE
            and 0.0 < other.acceleration - mode.acceleration < BESIDE
            for other in found
        )
        text = f"{100 * mode.mass:.0f} %"
        _mark(axes, mode.steering, mode.acceleration, text, is_below=is_lower)
    axes.plot(
        draws[:, 1], draws[:, 0], "o", color="white", mec="#1f2328", mew=0.5, ms=3.6, zorder=3
    )
    axes.set(
        xlim=(1 + half, -1 - half), ylim=(-1 - half, 1 + half), xticks=(1, 0, -1), yticks=(-1, 0, 1)
    )
    return image


def _mark(axes: Axes, steering: float, acceleration: float, text: str, *, is_below: bool) -> None:
    """Ring a mode, and write its mass above it, or below where it is asked for or the panel ends."""
    axes.plot(steering, acceleration, "o", color="none", mec="#d1242f", mew=1.4, ms=9.0, zorder=4)
    up = acceleration < 0.5 and not is_below
    axes.annotate(
        text,
        (steering, acceleration),
        xytext=(0, 11 if up else -11),
        textcoords="offset points",
        ha="left" if steering > 0.7 else "right" if steering < -0.7 else "center",
        va="bottom" if up else "top",
        fontsize=7.5,
        color="white",
        bbox={"boxstyle": "round,pad=0.15", "facecolor": "#1f2328", "alpha": 0.6, "linewidth": 0},
        zorder=5,
    )
