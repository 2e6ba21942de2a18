"""Show a moment of a demonstration as it was driven and from perturbed poses: `python scripts/perturbed_views.py --help`."""

import argparse
from collections.abc import Iterable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from mjdrive import geometry, picture_style
from mjdrive.bev.picture import picture
from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig, CollectConfig
from mjdrive.datatypes import Episode
from mjdrive.episodes.collection import collect_route
from mjdrive.learning.perturbation import perturb
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing
from mjdrive.vehicle.parameters import VehicleParameters
from models.config import PerturbationConfig

TOWN, ROUTE = "town02", "route0"

SHOWN = 40.0
"""Length of the driven way that is drawn [m]."""

SEEDS = (8, 11, 1)
"""Chance of the poses that are shown, so that they differ."""

WAY, AHEAD = "#8250df", 26.0
"""Colour of the driven way, and how much of the view is shown [m]."""


def before_a_turn(episode: Episode) -> int:
    """A step two seconds before the hardest turn to the left."""
    return max(int(np.argmax(episode.labels[:, 1] * (episode.vehicle[:, 3] > 3))) - 20, 0)


def show(axes: Axes, seen: Episode, driven: Episode, step: int, projector: BevProjector) -> None:
    """Draw the view from one pose, with the way that was driven."""
    config = projector.config
    x, y, yaw = map(float, seen.vehicle[step, :3])
    bev = projector.project(
        x=x, y=y, yaw=yaw, time=float(seen.time[step]), light_phase=seen.light_phase
    )
    axes.imshow(picture(bev, config, VehicleParameters.default(), scale=4))
    way = driven.vehicle[step:, :2]
    way = way[np.cumsum(np.hypot(*np.diff(way, axis=0, prepend=way[:1]).T)) < SHOWN]
    ahead, left = geometry.vehicle_from_world(way, x=x, y=y, yaw=yaw).T
    rows = _row(config, ahead)
    columns = 4 * (config.size_px / 2 - config.pixels_per_metre * left)
    axes.plot(columns, rows, color=WAY, lw=1.6)
    half = 4 * config.pixels_per_metre * 0.5 * AHEAD
    middle = 4 * config.size_px / 2
    axes.set(
        xlim=(middle - half, middle + half),
        ylim=(_row(config, -6.0), _row(config, AHEAD - 6.0)),
        xticks=[],
        yticks=[],
    )
    axes.spines[:].set_visible(False)
    moved = _moved(driven.vehicle[step, :3], seen.vehicle[step, :3])
    axes.set_title(f"{moved}\nsteering {seen.labels[step, 1]:+.2f}")


def _row(config: BevConfig, ahead: float | np.ndarray) -> float | np.ndarray:
    """Row of the picture of a place so far ahead of the rear axle."""
    origin = config.size_px - config.ego_above_bottom_px
    return 4 * (origin - config.pixels_per_metre * (ahead - config.origin_ahead_of_rear_axle))


def _moved(before: np.ndarray, after: np.ndarray) -> str:
    """In words, by how much a pose was moved."""
    if (before == after).all():
        return "as it was driven"
    shift = after[:2] - before[:2]
    offset = float(-np.sin(before[2]) * shift[0] + np.cos(before[2]) * shift[1])
    turn = float(after[2] - before[2])
    sides = ("left" if offset > 0 else "right", "left" if turn > 0 else "right")
    return f"{abs(offset):.1f} m {sides[0]}, turned {abs(turn):.2f} rad {sides[1]}"


def main(words: Iterable[str] | None = None) -> None:
    """Drive, perturb and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", type=Path, default=Path("perturbation.png"))
    options = parser.parse_args(None if words is None else list(words))
    town = library.load(TOWN)
    route = routing.route_through(town, np.array(library.load_settings(TOWN).routes[ROUTE]))
    driven = collect_route(Simulation(town), route, config=CollectConfig(disturbance=None), seed=0)
    step = before_a_turn(driven)
    config = PerturbationConfig(share=1.0)
    seen = [driven, *(perturb(driven, config, np.random.default_rng(seed)) for seed in SEEDS)]
    with plt.rc_context(picture_style.STYLE):
        figure, grid = plt.subplots(1, len(seen), figsize=(11, 3.4), layout="constrained")
        for axes, episode in zip(grid, seen, strict=True):
            show(axes, episode, driven, step, BevProjector(town))
        picture_style.save(figure, options.picture)
        plt.close(figure)


if __name__ == "__main__":
    main()
