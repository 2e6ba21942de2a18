"""Let policies drive a town with the same seeds and print a table: mean and standard deviation over the seeds.

A drive is clean that had no collision, never left the road and went at least 100 m. A branch is one way through one
junction.

Example: python scripts/compare_policies.py pid runs/bc-beta runs/ibc runs/da-ibc --out drives/comparison
"""

from collections.abc import Sequence
from pathlib import Path

import click

from mjdrive import versions
from mjdrive.cli.console import episode_bars
from mjdrive.cli.driver import find_driver
from mjdrive.cli.main import Script
from mjdrive.cli.options import Jobs, chosen_executor, executor_options
from mjdrive.datatypes import Town
from mjdrive.errors import NameTakenError
from mjdrive.evaluation.drives import Driving, PlannedDrive, make_drives
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.evaluation.spread import FIGURES, summarise_drives
from mjdrive.expert import experts
from mjdrive.town import library
from mjdrive.vehicle import cars


def as_row(name: str, drives: list[DriveSummary], town: Town) -> str:
    """One line of the table, in Markdown."""
    summary = summarise_drives(drives, town)
    cells = [
        name,
        *(str(summary.figures[column]) for column in FIGURES),
        f"{len(summary.branches_taken)} of {summary.branches}",
        f"{summary.clean} of {summary.episodes}",
    ]
    return f"| {' | '.join(cells)} |"


def folders_of(policies: Sequence[str], out: Path) -> list[Path]:
    """Folders of the drives of each policy, called as it is.

    Raises:
        NameTakenError: If two are called the same.
    """
    names = [Path(name).name for name in policies]
    for name in names:
        if names.count(name) > 1:
            alike = ", ".join(it for it in policies if Path(it).name == name)
            raise NameTakenError(
                f"{alike} would all drive into '{out / name}'. Expected policies of different names: rename a run, or "
                f"compare them with another --out."
            )
    return [out / name for name in names]


@click.command(cls=Script)
@click.argument("policies", nargs=-1, required=True)
@click.option("--town", "town_name", default="town02", show_default=True)
@click.option("--steps", "num_steps", default=3000, show_default=True)
@click.option("--seeds", "num_seeds", default=5, show_default=True, help="Seeds 0, 1, ...")
@click.option("--preset", help="How trained policies choose their actions.")
@executor_options
@click.option("--out", type=click.Path(path_type=Path), default=Path("drives/comparison"))
def main(
    *,
    policies: tuple[str, ...],
    town_name: str,
    num_steps: int,
    num_seeds: int,
    preset: str | None,
    jobs: Jobs,
    backend: str,
    address: str | None,
    out: Path,
) -> None:
    """Compare policies on the same starts, lights and seeds."""
    town, car = library.load(town_name), cars.load()
    executor = chosen_executor(jobs, backend, address)
    drivers = [
        find_driver(name, Path("runs"), preset=None if name in experts.NAMES else preset)
        for name in policies
    ]
    folders = folders_of(policies, out)
    planned = [PlannedDrive(f"seed-{seed}", seed) for seed in range(num_seeds)]
    print(f"| policy | {' | '.join(FIGURES.values())} | branches, all seeds | clean drives |")
    print(f"|{'---|' * (len(FIGURES) + 3)}")
    for driver, folder in zip(drivers, folders, strict=True):
        with episode_bars(driver.name, total=num_seeds) as progress:
            drives = make_drives(
                Driving(driver, town, car, num_steps, versions.all_versions()),
                planned,
                folder,
                description={"town": town.name, **driver.metadata(town, car, num_steps)},
                executor=executor,
                report_progress=progress,
            )
        print(as_row(driver.name, drives, town))


if __name__ == "__main__":
    main()
