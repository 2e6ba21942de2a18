"""Time `Rules.check` on one drive, and compare it with another checkout of mjdrive: A B A B, medians, ratio.

The drive follows random turns through a town at 6 m/s, with the lights as they change. Every round runs in a process
of its own and counts its processor time, so that a busy machine troubles both alike.

Example: git worktree add ../before HEAD~20; python scripts/bench/rules.py --before ../before
"""

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import click
import numpy as np

from mjdrive.datatypes import VehicleState
from mjdrive.simulation.rules import Rules
from mjdrive.town import library, routing, signals
from mjdrive.vehicle.parameters import VehicleParameters

HERE = Path(__file__).resolve().parents[2]

NUM_STEPS = 3000
"""Control steps of the drive [-]."""


def seconds_per_call(town_name: str) -> float:
    """Drive once and time every call of `check`; the first visit to each place is part of it."""
    town = library.load(town_name)
    lane, _ = routing.random_start(town, np.random.default_rng(0))
    length = 0.6 * NUM_STEPS
    route = routing.random_route(
        town, lane=lane, station=0.0, length=length, rng=np.random.default_rng(0)
    )
    along = np.linspace(0.0, length, NUM_STEPS)
    columns = (*route.points.T, np.unwrap(route.yaw))
    poses = np.stack([np.interp(along, route.station, column) for column in columns], axis=1)
    drive = [VehicleState(x, y, yaw, 6.0, 0.0, 0.0) for x, y, yaw in poses.tolist()]
    shown = [signals.all_at(town, 0.1 * step) for step in range(NUM_STEPS)]
    rules = Rules(town, VehicleParameters.default())
    begin = time.process_time()
    for step, vehicle in enumerate(drive):
        rules.check(time=0.1 * step, vehicle=vehicle, lights=shown[step], hits=())
    return (time.process_time() - begin) / NUM_STEPS


def run(checkout: Path, town: str) -> float:
    """One round in a process of its own, with the packages of a checkout."""
    environment = {**os.environ, "PYTHONPATH": str(checkout), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, __file__, "--town", town, "--one"]
    other = subprocess.run(
        command, cwd=checkout, env=environment, capture_output=True, text=True, check=True
    )
    return float(other.stdout)


@click.command()
@click.option("--town", default="town01", show_default=True)
@click.option("--rounds", default=5, show_default=True, help="Drives of each checkout.")
@click.option("--before", type=click.Path(path_type=Path, exists=True), help="Another checkout.")
@click.option("--one", is_flag=True, hidden=True)
def main(*, town: str, rounds: int, before: Path | None, one: bool) -> None:
    """Time the rules."""
    if one:
        print(seconds_per_call(town))
        return
    checkouts = {"here": HERE} | ({"before": before.resolve()} if before else {})
    times: dict[str, list[float]] = {name: [] for name in checkouts}
    for _ in range(rounds):
        for name, checkout in checkouts.items():
            times[name].append(run(checkout, town))
    for name, values in times.items():
        print(
            f"{name:7s} {1e6 * statistics.median(values):6.1f} us a call, {town}, {rounds} rounds"
        )
    if before:
        ratio = statistics.median(times["here"]) / statistics.median(times["before"])
        print(f"here / before {ratio:.2f}")


if __name__ == "__main__":
    main()
