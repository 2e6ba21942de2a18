"""The folder that tuning leaves behind: the settings with their evidence, every trial, a picture."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mjdrive import config
from mjdrive.picture_style import STYLE, save
from mjdrive.tuning.course import Trace
from mjdrive.tuning.gains import plain
from mjdrive.tuning.search import Tried, best
from mjdrive.tuning.tune import Tuning

GAINS = "gains.json"
TRIALS = "trials.json"
PICTURE = "tuning.png"

BEFORE, AFTER = "#8c959f", "#0969da"
"""Colours of the settings at the start and of the tuned ones."""

SHOWN_COST = 3.0
"""Trials that cost more than this times the first are drawn at the upper edge [-]."""


def write_tuning(tuning: Tuning, folder: Path) -> None:
    """Write the trials, the picture and, last of all, the settings.

    Args:
        tuning: What was found.
        folder: New folder for `gains.json`, `trials.json` and `tuning.png`.
    """
    trials: list[dict[str, Any]] = [
        {"settings": plain(tried.settings), "marks": plain(tried.marks)} for tried in tuning.tried
    ]
    config.write_json(trials, folder / TRIALS)
    draw_tuning(tuning, folder / PICTURE)
    config.write_json(tuning.gains, folder / GAINS)


def draw_tuning(tuning: Tuning, path: Path) -> None:
    """Draw what the trials cost, and how the course was driven before and after.

    Args:
        tuning: What was found.
        path: PNG file to write.
    """
    gains = tuning.gains
    driven = gains.checked_on or gains.tuned_on
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(8.0, 8.0), layout="constrained")
        costs, offsets, commands = figure.subplots(3, 1)
        figure.suptitle(
            f"{gains.expert} in car '{gains.car}': tuned in {gains.tuned_on.town}, driven in {driven.town}"
        )
        _draw_costs(costs, tuning.tried)
        for traces, colour, label, marks in (
            (tuning.before, BEFORE, "before", driven.before),
            (tuning.after, AFTER, "after", driven.after),
        ):
            text = f"{label}: {100 * marks.offset_rms_m:.0f} cm RMS"
            offsets.plot(_metres(traces), _offsets(traces), color=colour, label=text, lw=1.0)
            first = traces[0].episode
            text = f"{label}: whiteness {marks.steering_whiteness:.2f} 1/s"
            commands.plot(first.time, first.labels[:, 1], color=colour, label=text)
        offsets.set(xlabel="way along all exercises [m]", ylabel="left of the route [m]")
        commands.set(xlabel="time in the tightest bend [s]", ylabel="steering command [-]")
        for axes in (offsets, commands):
            axes.axhline(0.0, color="#d0d7de", lw=0.8, zorder=0)
            _legend_above(axes)
        save(figure, path)


def _draw_costs(axes: Axes, tried: Sequence[Tried]) -> None:
    costs = np.array([one.marks.cost for one in tried])
    ceiling = SHOWN_COST * costs[0]
    axes.plot(np.minimum(costs, ceiling), ".", color=BEFORE, label="a trial")
    axes.step(
        np.arange(len(costs)),
        np.minimum.accumulate(costs),
        where="post",
        color=AFTER,
        label=f"best so far: {costs[0]:.2f} at the start, {best(tuple(tried)).marks.cost:.2f} at the end",
    )
    axes.set(xlabel="trial", ylabel="cost [-]", ylim=(0.0, 1.05 * ceiling))
    _legend_above(axes)


def _legend_above(axes: Axes) -> None:
    axes.legend(frameon=False, loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2)


def _metres(traces: Sequence[Trace]) -> np.ndarray:
    """Way driven through all exercises, a gap between two [m]."""
    parts: list[np.ndarray] = []
    start = 0.0
    for trace in traces:
        steps = np.hypot(*np.diff(trace.episode.vehicle[:, :2], axis=0).T)
        way = start + np.concatenate([[0.0], np.cumsum(steps)])
        parts += [way, np.array([np.nan])]
        start = way[-1]
    return np.concatenate(parts)


def _offsets(traces: Sequence[Trace]) -> np.ndarray:
    """Distance from the route, NaN between two exercises [m]."""
    gap = np.array([np.nan])
    return np.concatenate([part for trace in traces for part in (trace.offsets, gap)])
