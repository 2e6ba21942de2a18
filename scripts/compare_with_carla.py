"""Compare how mjdrive and CARLA read a map, or a map of ours with CARLA's map of the same town.

The exit status is 1 if a bar is broken. Needs `pip install carla==0.9.16`, but no CARLA server.

Examples:
    python scripts/compare_with_carla.py assets/towns/town01/map.xodr
    python scripts/compare_with_carla.py assets/towns/town01/map.xodr --reference Town01.xodr
"""

import sys
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import click
import numpy as np
import shapely
from map_readings import Reading, read_with_carla, read_with_mjdrive
from rich.console import Console
from rich.table import Table

from mjdrive.geometry import headings, resample

SAME_CENTRE = 0.001
"""Largest distance of two readings of one lane [m]."""

SAME_STOP = 0.05
"""Largest distance of two readings of one stop point [m]."""

LIKE_CENTRE_MEAN = 0.10
"""Largest mean distance of the lanes of two maps of one town [m]."""

LIKE_CENTRE_MOST = 0.50
"""Largest distance of the lanes of two maps of one town, for 99 % of their points [m]."""

FARTHEST = 5.0
"""Lanes further apart than this are not the same [m]."""

_SAME_WAY = np.pi / 3
"""Lanes that differ more in direction are not compared [rad]."""


@dataclass(frozen=True)
class Row:
    """One line of the comparison.

    Attributes:
        what: What is compared.
        ours: What mjdrive says.
        theirs: What CARLA says.
        difference: How far they are apart.
        holds: Whether the bar holds.
    """

    what: str
    ours: str
    theirs: str
    difference: str
    holds: bool


def compare_readings(ours: Reading, theirs: Reading) -> list[Row]:
    """Compare two readings of one map: they have to be the same."""
    shared = sorted(ours.lanes.keys() & theirs.lanes.keys())
    centres = [distance(ours.lanes[name], theirs.lanes[name]) for name in shared]
    ends = [
        float(np.hypot(*(ours.lanes[name][end] - theirs.lanes[name][end])))
        for name in shared
        for end in (0, -1)
    ]
    stops = [
        float(np.hypot(*(ours.stops[key] - theirs.stops[key])))
        for key in ours.stops.keys() & theirs.stops.keys()
    ]
    return [
        _same_names("driving lanes", ours.lanes, theirs.lanes),
        _same_names("successors", ours.followings, theirs.followings),
        _same_names("junctions", ours.junctions, theirs.junctions),
        _same_names("moves across junctions", ours.moves, theirs.moves),
        _same_names("lights", ours.signals, theirs.signals),
        _same_names("lanes stopped by lights", ours.stops, theirs.stops),
        _within("lane centres, largest distance", centres, SAME_CENTRE),
        _within("lane starts and ends", ends, SAME_CENTRE),
        _within("stop points", stops, SAME_STOP),
    ]


def compare_towns(ours: Reading, theirs: Reading) -> list[Row]:
    """Compare two maps of one town, drawn by different people: they have to be alike."""
    away = np.concatenate([nearest_distances(ours, theirs), nearest_distances(theirs, ours)])
    mean, most = float(away.mean()), float(np.quantile(away, 0.99))
    counts = [
        Row(what, str(first), str(second), "", first == second)
        for what, first, second in (
            ("junctions", len(ours.junctions), len(theirs.junctions)),
            ("moves across junctions", len(ours.moves), len(theirs.moves)),
            ("lights", len(ours.signals), len(theirs.signals)),
        )
    ]
    return [
        *counts,
        Row("lane centres, mean", "", "", f"{mean * 100:.1f} cm", mean < LIKE_CENTRE_MEAN),
        Row("lane centres, 99 %", "", "", f"{most * 100:.1f} cm", most < LIKE_CENTRE_MOST),
    ]


def distance(first: np.ndarray, second: np.ndarray) -> float:
    """Largest distance of a point of either polyline from the other polyline [m]."""
    lines = shapely.linestrings(first), shapely.linestrings(second)
    return max(
        float(shapely.distance(shapely.points(points), line).max())
        for points, line in ((first, lines[1]), (second, lines[0]))
    )


def nearest_distances(ours: Reading, theirs: Reading) -> np.ndarray:
    """Distance from points 1 m apart on our lanes to the nearest of their lanes in the same direction.

    Returns:
        Distances, shape (N,); infinite beyond `FARTHEST` [m].
    """
    lines = [resample(line, 1.0) for line in theirs.lanes.values()]
    segments = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    ways = np.arctan2(*(segments[:, 1] - segments[:, 0]).T[::-1])
    own = [resample(line, 1.0) for line in ours.lanes.values()]
    points = shapely.points(np.concatenate(own))
    yaw = np.concatenate([headings(line) for line in own])
    chords = shapely.linestrings(segments)
    point, chord = shapely.STRtree(chords).query(points, predicate="dwithin", distance=FARTHEST)
    is_same_way = np.cos(yaw[point] - ways[chord]) > np.cos(_SAME_WAY)
    point, chord = point[is_same_way], chord[is_same_way]
    away = np.full(len(points), np.inf)
    np.minimum.at(away, point, shapely.distance(points[point], chords[chord]))
    return away


def _same_names(what: str, ours: Collection[object], theirs: Collection[object]) -> Row:
    apart = sorted(map(str, set(ours) ^ set(theirs)))
    text = f"{len(apart)} differ: {', '.join(apart[:3])}" if apart else "none"
    return Row(what, str(len(ours)), str(len(theirs)), text, not apart)


def _within(what: str, distances: list[float], bar: float) -> Row:
    largest = max(distances, default=0.0)
    return Row(what, "", "", f"{largest * 1000:.3f} mm", largest <= bar)


@click.command()
@click.argument("path", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option(
    "--reference",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="CARLA's map of the same town.",
)
def main(path: Path, reference: Path | None) -> None:
    """Compare mjdrive's reading of PATH with CARLA's reading of it, or of REFERENCE."""
    ours = read_with_mjdrive(path)
    try:
        theirs = read_with_carla(reference or path)
    except (RuntimeError, IndexError) as error:
        raise click.ClickException(f"CARLA cannot read '{reference or path}': {error}") from error
    rows = compare_readings(ours, theirs) if reference is None else compare_towns(ours, theirs)
    table = Table(title=f"{path.name}: mjdrive and CARLA", box=None, header_style="bold")
    for heading in ("", "mjdrive", "CARLA", "difference", ""):
        table.add_column(heading)
    for row in rows:
        table.add_row(row.what, row.ours, row.theirs, row.difference, "" if row.holds else "BROKEN")
    Console().print(table)
    sys.exit(0 if all(row.holds for row in rows) else 1)


if __name__ == "__main__":
    main()
