"""Let policies drive a town with the same seeds and print a table: mean and standard deviation over the seeds.

A drive is clean that had no collision, never left the road and went at least 100 m. A branch is one way through one
junction.

Example: python scripts/compare_policies.py pid runs/bc-beta runs/ibc runs/da-ibc --out drives/comparison
"""

import multiprocessing
import os
import statistics
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import click

from mjdrive.cli.driver import find_driver
from mjdrive.evaluation import report
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.expert import experts
from mjdrive.town import library

COLUMNS = (
    "distance_m",
    "red_lights",
    "collisions",
    "kerb_strikes",
    "off_road_s",
    "stuck_s",
    "score",
)
LEAST_DISTANCE = 100.0
"""A drive shorter than this is not clean, it is no drive [m]."""


def drive_once(job: tuple[str, str | None, str, int, int, Path]) -> DriveSummary:
    """Drive one policy with one seed into a folder of its own."""
    policy, preset, town_name, num_steps, seed, folder = job
    town = library.load(town_name)
    driver = find_driver(policy, Path("runs"), preset=preset)
    episode = driver.drive(town, num_steps=num_steps, seed=seed, on_step=lambda done: None)
    return report.write_drive(episode, town, folder)


def as_row(name: str, drives: list[DriveSummary], num_branches: int) -> str:
    """One line of the table, in Markdown."""
    cells = [name]
    for column in COLUMNS:
        values = [float(getattr(drive, column)) for drive in drives]
        spread = statistics.stdev(values) if len(values) > 1 else 0.0
        cells.append(f"{statistics.mean(values):.1f} ± {spread:.1f}")
    taken = {branch for drive in drives for branch in drive.branches_taken}
    is_clean = [
        drive.distance_m >= LEAST_DISTANCE and drive.collisions == 0 and drive.off_road_s == 0
        for drive in drives
    ]
    cells += [f"{len(taken)} of {num_branches}", f"{sum(is_clean)} of {len(drives)}"]
    return f"| {' | '.join(cells)} |"


@click.command()
@click.argument("policies", nargs=-1, required=True)
@click.option("--town", "town_name", default="town02", show_default=True)
@click.option("--steps", "num_steps", default=3000, show_default=True)
@click.option("--seeds", "num_seeds", default=5, show_default=True, help="Seeds 0, 1, ...")
@click.option("--preset", help="How trained policies choose their actions.")
@click.option("--jobs", default=os.cpu_count(), show_default=True, help="Drives at a time.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("drives/comparison"))
def main(
    *,
    policies: tuple[str, ...],
    town_name: str,
    num_steps: int,
    num_seeds: int,
    preset: str | None,
    jobs: int,
    out: Path,
) -> None:
    """Compare policies on the same starts, lights and seeds."""
    os.environ["OMP_NUM_THREADS"] = "1"  # one drive a core is quicker than one drive on all
    plan = [
        (policy, acting, town_name, num_steps, seed, out / f"{Path(policy).name}-{seed}")
        for policy, acting in (
            (name, None if name in experts.NAMES else preset) for name in policies
        )
        for seed in range(num_seeds)
    ]
    for job in plan:
        report.require_new(job[-1])
    print(f"| policy | {' | '.join(COLUMNS)} | branches, all seeds | clean drives |")
    print(f"|{'---|' * (len(COLUMNS) + 3)}")
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context) as pool:
        drives = list(pool.map(drive_once, plan))
    lanes = library.load(town_name).lanes.values()
    num_branches = sum(lane.junction is not None for lane in lanes)
    for index, policy in enumerate(policies):
        of_policy = drives[index * num_seeds : (index + 1) * num_seeds]
        print(as_row(Path(policy).name, of_policy, num_branches))


if __name__ == "__main__":
    main()
