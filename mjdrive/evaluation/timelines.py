"""Curves of a drive over time: PNG, the same bytes for the same drive, drawn without a display."""

from pathlib import Path

import matplotlib.style
import numpy as np
from jaxtyping import Bool
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import offset_copy

from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation import lane_keeping, metrics
from mjdrive.evaluation.figure_style import SYMBOLS, title
from mjdrive.picture_style import STYLE, save

LINE_COLOR = "#0550ae"
"""Colour of curves over time."""

ROW_PT = 11.0
"""Height of a row of symbols above a time axis [pt]."""


def draw_actions(episode: Episode, town: Town, path: Path) -> None:
    """Draw speed, commands and lane keeping of a drive over time; waiting at a light is shaded.

    Args:
        episode: The drive.
        town: The town that it was driven in.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(9.0, 7.0), layout="constrained")
        rows = figure.subplots(4, 1, sharex=True)
        waits = metrics.waits_at_light(episode, town) & metrics.stands(episode)
        curves = (3.6 * episode.vehicle[:, 3], episode.actions[:, 0], episode.actions[:, 1])
        labels = (
            "speed [km/h]",
            "acceleration [-]\nbrake < 0 < throttle",
            "steering [-]\nright < 0 < left",
        )
        for axes, curve, label, limits in zip(
            rows[:3], curves, labels, (None, (-1.05, 1.05), (-1.05, 1.05)), strict=True
        ):
            axes.plot(episode.time, curve, color=LINE_COLOR, linewidth=0.9)
            axes.set(ylabel=label, ylim=limits)
        _draw_offset(rows[3], episode, town)
        for axes in rows:
            _shade(axes, episode, waits)
            axes.axhline(0.0, color="0.7", linewidth=0.6, zorder=1)
            axes.margins(x=0.01)
            for infraction in episode.infractions:
                axes.axvline(infraction.time, color=SYMBOLS[infraction.kind][2], linewidth=0.9)
        num_rows = _draw_infraction_times(figure, rows[0], episode)
        figure.set_figheight(7.0 + ROW_PT / 72 * num_rows)
        rows[-1].set_xlabel("time [s]")
        rows[0].set_title(title(episode), pad=6.0 + ROW_PT * num_rows)
        figure.align_ylabels(rows)
        handles, texts = rows[0].get_legend_handles_labels()
        if handles:
            figure.legend(handles, texts, loc="outside lower center", ncols=4, frameon=False)
        save(figure, path)


def _draw_infraction_times(figure: Figure, axes: Axes, episode: Episode) -> int:
    """Set the symbol of each infraction above its time, each kind in a row of its own; tell how many rows."""
    kinds = [kind for kind in SYMBOLS if any(it.kind == kind for it in episode.infractions)]
    for row, kind in enumerate(kinds):
        label, marker, color = SYMBOLS[kind]
        times = [it.time for it in episode.infractions if it.kind == kind]
        axes.plot(
            times,
            np.ones(len(times)),
            marker,
            color=color,
            mec="white",
            markersize=12 if marker == "*" else 8,
            label=f"{label} ({len(times)})",
            transform=offset_copy(
                axes.get_xaxis_transform(), figure, y=6.0 + ROW_PT * row, units="points"
            ),
            clip_on=False,
            zorder=4,
        )
    return len(kinds)


def _draw_offset(axes: Axes, episode: Episode, town: Town) -> None:
    """Draw the distance from the centre of the lane, with gaps in junctions and off the road."""
    lanes = lane_keeping.track(episode, town)
    offset = np.where(episode.on_lane & ~lanes.in_junction, lanes.offset, np.nan)
    axes.plot(episode.time, offset, color=LINE_COLOR, linewidth=0.9)
    largest = float(np.nanmax(np.abs(offset), initial=1.0))
    axes.set(
        ylabel="lane offset [m]\nright < 0 < left\n(gaps: junctions)",
        ylim=(-1.05 * largest, 1.05 * largest),
    )


def _shade(axes: Axes, episode: Episode, waits: Bool[np.ndarray, " T"]) -> None:
    """Shade the times in which the car waits at a light."""
    edges = np.flatnonzero(np.diff(waits, prepend=False, append=False))
    label = "waits at a red or yellow light"
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        start, end = episode.time[first], episode.time[last - 1]
        axes.axvspan(start, end, color="#ffd8d3", linewidth=0, label=label, zorder=0)
        label = "_nolegend_"
