"""What many drives of one policy are worth: mean and standard deviation of their figures, and a picture of them."""

import statistics
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib.style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from mjdrive.datatypes import Town
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.picture_style import STYLE, save

FIGURES = {
    "distance_m": "distance [m]",
    "red_lights": "red lights run",
    "collisions": "collisions",
    "kerb_strikes": "kerbs hit",
    "off_road_s": "off road [s]",
    "wrong_ways": "wrong ways",
    "stuck_s": "stuck [s]",
    "score": "score",
}
"""The figures of a drive that are averaged, and what people call them."""

LEAST_DISTANCE = 100.0
"""A drive shorter than this is not clean, it is no drive [m]."""


@dataclass(frozen=True, slots=True)
class Spread:
    """How a figure varies from drive to drive, in its own unit.

    Attributes:
        mean: Over the drives.
        deviation: Standard deviation of the sample; 0 for a single drive.
        smallest: Of the drives.
        largest: Of the drives.
    """

    mean: float
    deviation: float
    smallest: float
    largest: float

    def __str__(self) -> str:
        """Mean and standard deviation, as a table has them."""
        return f"{self.mean:,.1f} ± {self.deviation:.1f}"


@dataclass(frozen=True, slots=True)
class DrivesSummary:
    """The figures of several drives of one policy.

    Attributes:
        town: Name of the town.
        car: Name of the car.
        policy: Name of the policy that drove.
        episodes: Number of drives [-].
        clean: Drives of 100 m or more with no collision that never left the road [-].
        steps: Control steps of all drives [-].
        figures: Spread of each figure of `FIGURES` over the drives.
        branches_taken: How often each way through a junction was driven, by the name of its lane [-].
        branches: Ways through junctions that the town has [-].
        seeds: Seed of each drive [-].
        versions: Versions of the software that drove.
    """

    town: str
    car: str
    policy: str
    episodes: int
    clean: int
    steps: int
    figures: Mapping[str, Spread]
    branches_taken: Mapping[str, int]
    branches: int
    seeds: tuple[int, ...]
    versions: Mapping[str, str]


def summarise_drives(drives: Sequence[DriveSummary], town: Town) -> DrivesSummary:
    """Average several drives of one policy.

    Args:
        drives: The figures of each, at least one.
        town: The town that they were driven in.
    """
    branches: Counter[str] = Counter()
    for drive in drives:
        branches.update(drive.branches_taken)
    first = drives[0]
    return DrivesSummary(
        town=first.town,
        car=first.car,
        policy=first.policy,
        episodes=len(drives),
        clean=sum(is_clean(drive) for drive in drives),
        steps=sum(drive.steps for drive in drives),
        figures={name: _spread(values_of(name, drives)) for name in FIGURES},
        branches_taken=dict(sorted(branches.items())),
        branches=sum(lane.junction is not None for lane in town.lanes.values()),
        seeds=tuple(drive.seed for drive in drives),
        versions=first.versions,
    )


def is_clean(drive: DriveSummary) -> bool:
    """Whether a drive went somewhere, hit nothing and stayed on the road."""
    return drive.distance_m >= LEAST_DISTANCE and drive.collisions == 0 and drive.off_road_s == 0.0


def values_of(name: str, drives: Sequence[DriveSummary]) -> list[float]:
    """One figure of each drive, in its own unit."""
    return [float(getattr(drive, name)) for drive in drives]


def draw_spread(drives: Sequence[DriveSummary], path: Path) -> None:
    """Draw each figure of each drive, with mean and standard deviation.

    Args:
        drives: The figures of each drive, at least one.
        path: PNG file to write.
    """
    with matplotlib.style.context(["default", STYLE]):
        figure = Figure(figsize=(10.0, 4.6), layout="constrained")
        grid = figure.subplots(2, len(FIGURES) // 2)
        for axes, (name, title) in zip(grid.flat, FIGURES.items(), strict=True):
            _draw_values(axes, values_of(name, drives), title)
        for axes in grid[-1]:
            axes.set_xlabel("episode", fontsize=8)
        figure.suptitle(
            f"{drives[0].policy} in {drives[0].town}: {len(drives)} drives", fontsize=10
        )
        save(figure, path)


def _draw_values(axes: Axes, values: Sequence[float], title: str) -> None:
    spread = _spread(values)
    axes.axhspan(spread.mean - spread.deviation, spread.mean + spread.deviation, color="#dbe7f3")
    axes.axhline(spread.mean, color="#3b6ea5", linewidth=1.2)
    axes.plot(range(len(values)), values, "o", color="#1f2328", markersize=3.0, clip_on=False)
    axes.set_ylim(bottom=0.0, top=1.1 * max(spread.largest, spread.mean + spread.deviation) or 1.0)
    axes.set_xlim(-0.5, len(values) - 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=6, integer=True))
    axes.set_title(f"{title}: {spread}", fontsize=8)


def _spread(values: Sequence[float]) -> Spread:
    return Spread(
        mean=_rounded(statistics.fmean(values)),
        deviation=_rounded(statistics.stdev(values)) if len(values) > 1 else 0.0,
        smallest=min(values),
        largest=max(values),
    )


def _rounded(value: float) -> float:
    """Drop the digits below a tenth of a millimetre or millisecond, which carry no meaning."""
    return round(value, 4)
