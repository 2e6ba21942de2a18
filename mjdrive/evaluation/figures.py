"""Pictures of drives and data sets: PNG, the same bytes for the same drive, drawn without a display."""

import io
import math
from collections.abc import Mapping
from pathlib import Path

import matplotlib.style
import numpy as np
from jaxtyping import Bool
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from mjdrive.datatypes import Episode, InfractionKind, Town
from mjdrive.evaluation import metrics
from mjdrive.files import write_atomically
from mjdrive.town.surface import lane_polygons

STYLE = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.dpi": 150.0,
    "savefig.dpi": 150.0,
}
"""On top of matplotlib's defaults, so that a user's own style does not change the bytes."""

SYMBOLS = {
    InfractionKind.RED_LIGHT: ("red light run", "X", "#d1242f"),
    InfractionKind.COLLISION: ("collision", "*", "#8250df"),
    InfractionKind.OFF_ROAD: ("left the road", "s", "#bc4c00"),
    InfractionKind.KERB: ("kerb struck", "^", "#0969da"),
}
"""Legend text, marker and colour of each kind of infraction."""

MARGIN = 12.0
"""Ground shown around the lanes [m]."""


def draw_trajectory(episode: Episode, town: Town, path: Path) -> None:
    """Draw the path of a drive over the map of the town, coloured by time, infractions marked.

    Args:
        episode: The drive.
        town: The town that it was driven in.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        width, height = _extent(town)
        figure = Figure(figsize=(7.5, 6.2 * height / width + 0.9), layout="constrained")
        axes = figure.add_subplot()
        _draw_town(axes, town)
        line = _draw_path(axes, episode, line_width=2.2)
        _draw_ends(axes, episode)
        _draw_infractions(axes, episode)
        axes.set(xlabel="x, east [m]", ylabel="y, north [m]", title=_title(episode, town))
        figure.colorbar(line, ax=axes, label="time [s]", shrink=0.7, pad=0.02)
        if len(episode.time):
            figure.legend(loc="outside lower center", ncols=6, frameon=False)
        _save(figure, path)


def draw_actions(episode: Episode, town: Town, path: Path) -> None:
    """Draw speed, acceleration and steering of a drive over time; waiting at a light is shaded.

    Args:
        episode: The drive.
        town: The town that it was driven in.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(9.0, 5.0), layout="constrained")
        rows = figure.subplots(3, 1, sharex=True)
        waits = metrics.waits_at_light(episode, town) & metrics.stands(episode)
        curves = (3.6 * episode.vehicle[:, 3], episode.actions[:, 0], episode.actions[:, 1])
        labels = (
            "speed [km/h]",
            "acceleration [-]\nbrake < 0 < throttle",
            "steering [-]\nright < 0 < left",
        )
        for axes, curve, label, limits in zip(
            rows, curves, labels, (None, (-1.05, 1.05), (-1.05, 1.05)), strict=True
        ):
            _shade(axes, episode, waits)
            axes.axhline(0.0, color="0.7", linewidth=0.6)
            axes.plot(episode.time, curve, color="#0550ae", linewidth=0.9)
            axes.set(ylabel=label, ylim=limits)
            axes.margins(x=0.01)
            for infraction in episode.infractions:
                axes.axvline(infraction.time, color=SYMBOLS[infraction.kind][2], linewidth=0.9)
        rows[-1].set_xlabel("time [s]")
        if waits.any():
            rows[0].legend(loc="upper right", fontsize=7, framealpha=0.9)
        rows[0].set_title(_title(episode, town))
        figure.align_ylabels(rows)
        _save(figure, path)


def draw_dataset(episodes: Mapping[str, Episode], town: Town, path: Path) -> None:
    """Draw every episode of a data set over the map of its town, one small map each.

    Args:
        episodes: The drives by name, at least one.
        town: The town that they were driven in.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        width, height = _extent(town)
        num_columns = min(len(episodes), 5)
        num_rows = math.ceil(len(episodes) / num_columns)
        figure = Figure(
            figsize=(2.6 * num_columns, (2.6 * height / width + 0.3) * num_rows),
            layout="constrained",
        )
        grid = figure.subplots(num_rows, num_columns, squeeze=False)
        for axes in grid.flat:
            axes.set_axis_off()
        for axes, (name, episode) in zip(grid.flat, episodes.items(), strict=False):
            _draw_town(axes, town)
            _draw_path(axes, episode, line_width=1.4)
            _draw_ends(axes, episode)
            _draw_infractions(axes, episode, size=25.0)
            axes.set_title(f"{name}: {metrics.distance_on_lanes(episode):,.0f} m", fontsize=8)
        _save(figure, path)


def _extent(town: Town) -> tuple[float, float]:
    """Width and height of the ground that is shown [m]."""
    return (
        float(town.bounds[2] - town.bounds[0]) + 2 * MARGIN,
        float(town.bounds[3] - town.bounds[1]) + 2 * MARGIN,
    )


def _draw_town(axes: Axes, town: Town) -> None:
    """Draw lanes and stop lines on equal axes."""
    lanes = [np.asarray(polygon.exterior.coords) for polygon in lane_polygons(town).values()]
    # The outline closes the hairline gaps between neighbouring lanes.
    axes.add_collection(
        PolyCollection(lanes, facecolor="#dcdfe3", edgecolor="#dcdfe3", linewidth=0.8)
    )
    stop_lines = [light.stop_line for light in town.lights.values()]
    axes.add_collection(LineCollection(stop_lines, color="#6e7781", linewidth=1.2))
    smallest_x, smallest_y, largest_x, largest_y = town.bounds
    axes.set(
        aspect="equal",
        xlim=(smallest_x - MARGIN, largest_x + MARGIN),
        ylim=(smallest_y - MARGIN, largest_y + MARGIN),
    )
    step = 100.0 if largest_x - smallest_x > 300 else 50.0
    axes.xaxis.set_major_locator(MultipleLocator(step))
    axes.yaxis.set_major_locator(MultipleLocator(step))


def _draw_path(axes: Axes, episode: Episode, *, line_width: float) -> LineCollection:
    """Draw the path of the rear axle, coloured by time."""
    points = episode.vehicle[:, :2]
    line = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)),
        array=episode.time[:-1],
        cmap="viridis",
        linewidth=line_width,
        capstyle="round",
        zorder=2,
    )
    line.set_clim(0.0, max(float(episode.time[-1]), 1.0) if len(episode.time) else 1.0)
    axes.add_collection(line)
    return line


def _draw_ends(axes: Axes, episode: Episode) -> None:
    """Mark where the drive began, which way the car looked, and where it ended."""
    if not len(episode.time):
        return
    x, y, yaw = episode.vehicle[0, :3]
    axes.plot(x, y, "o", color="white", mec="black", linestyle="", label="start", zorder=3)
    axes.plot(x, y, marker=(3, 0, math.degrees(yaw) - 90.0), color="black", ms=4, zorder=3)
    x, y = episode.vehicle[-1, :2]
    axes.plot(x, y, "s", color="black", markersize=4, linestyle="", label="end", zorder=3)


def _draw_infractions(axes: Axes, episode: Episode, *, size: float = 90.0) -> None:
    """Mark each infraction with the symbol of its kind; the legend counts them."""
    for kind, (label, marker, color) in SYMBOLS.items():
        places = [(it.x, it.y) for it in episode.infractions if it.kind == kind]
        if places:
            x, y = np.array(places).T
            text = f"{label} ({len(places)})"
            axes.scatter(
                x, y, s=size, marker=marker, color=color, edgecolor="white", label=text, zorder=4
            )


def _shade(axes: Axes, episode: Episode, waits: Bool[np.ndarray, " T"]) -> None:
    """Shade the times in which the car waits at a light."""
    edges = np.flatnonzero(np.diff(waits, prepend=False, append=False))
    label = "waits at a red or yellow light"
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        start, end = episode.time[first], episode.time[last - 1]
        axes.axvspan(start, end, color="#ffebe9", linewidth=0, label=label)
        label = "_nolegend_"


def _title(episode: Episode, town: Town) -> str:
    """Who drove where, and what came of it, in one line."""
    summary = metrics.summarise(episode, town)
    return (
        f"{episode.policy} in {episode.town}, seed {episode.seed}: {summary.distance_m:,.0f} m, "
        f"red lights {summary.red_lights}, collisions {summary.collisions}, off road {summary.off_road_s:.1f} s"
    )


def _save(figure: Figure, path: Path) -> None:
    """Write a figure without the version of the software that drew it."""
    picture = io.BytesIO()
    figure.savefig(picture, format="png", metadata={"Software": None})
    write_atomically(path, picture.getvalue())
