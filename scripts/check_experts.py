"""Let experts drive every route of some towns under many light seeds, and say whether each drive was flawless.

A drive is flawless with no infraction, no time off the road, no stop line passed on red or on a yellow that left room to
stop, and every start within a second of green. The MPC is held to its bars, too: how long it decides, how near it keeps
to its route, and, if the PID was checked with it, how smoothly it drives beside that. Exit status 1 names what failed.

With --out each drive is written as it is done; the same command goes on where it stopped. docs/experts.md has its tables
from docs/experts/checks.json (`python scripts/expert_tables.py`).

Example: python scripts/check_experts.py --expert pid --expert mpc --seeds 10 --out docs/experts/checks.json
"""

import dataclasses
import sys
from pathlib import Path

import click

from mjdrive.benchmarks import machine
from mjdrive.cli.console import progress_bars
from mjdrive.cli.expert_tables import (
    bars_table,
    comfort_table,
    laps_table,
    provenance,
    times_table,
)
from mjdrive.cli.main import Script
from mjdrive.cli.options import Jobs, chosen_executor, executor_options
from mjdrive.config import read_json
from mjdrive.evaluation.expert_bars import Clock, bars
from mjdrive.evaluation.expert_checks import Checking
from mjdrive.evaluation.expert_drives import Checks, Job
from mjdrive.expert import experts
from mjdrive.files import write_atomically
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.versions import code_digest


@click.command(cls=Script)
@click.option("--expert", "names", multiple=True, default=("pid",), show_default=True)
@click.option("--town", "towns", multiple=True, default=("town01", "town02"), show_default=True)
@click.option("--car", default="default", show_default=True)
@click.option("--seeds", "num_seeds", default=10, show_default=True, help="Light seeds 0, 1, ...")
@click.option(
    "--clock",
    type=click.Choice(["wall", "cpu"]),
    default="wall",
    show_default=True,
    help="What decisions may take by: the clock, or on a busy machine CPU time alone.",
)
@executor_options
@click.option("--out", type=click.Path(path_type=Path), help="JSON file for every drive.")
def main(
    *,
    names: tuple[str, ...],
    towns: tuple[str, ...],
    car: str,
    num_seeds: int,
    clock: Clock,
    jobs: Jobs,
    backend: str,
    address: str | None,
    out: Path | None,
) -> None:
    """Drive every route under every seed, print tables, and name what was not as it should be."""
    plan = [
        Job(experts.known(name), car, town, route, seed)
        for seed in range(num_seeds)
        for name in names
        for town in towns
        for route in library.load_settings(town).routes
    ]
    checks = going_on_with(out, made_with(car, towns))
    found = {it.job: it for it in checks.drives}
    executor = chosen_executor(jobs, backend, address)
    with progress_bars() as progress:
        task = progress.add_task("experts", total=len(plan), unit="drives")
        progress.advance(task, sum(job in found for job in plan))
        missing = [job for job in plan if job not in found]
        for job, done in executor.run(Checking(), missing, on_progress=lambda job, steps: None):
            found[job] = done
            progress.advance(task)
            drives = tuple(found[it] for it in dict.fromkeys((*plan, *found)) if it in found)
            checks = dataclasses.replace(checks, drives=drives)
            if out is not None:
                write_atomically(out, checks.to_text().encode())
    wanted = tuple(found[job] for job in plan)
    sys.exit(not told(dataclasses.replace(checks, drives=wanted), clock))


def made_with(car: str, towns: tuple[str, ...]) -> Checks:
    """What drives are made with here and now, and no drive yet."""
    here = dataclasses.asdict(machine.describe())
    return Checks(
        code=code_digest(),
        car_digest=cars.load(car).digest,
        town_digests={town: library.load(town).digest for town in towns},
        machine=here,
    )


def going_on_with(out: Path | None, here: Checks) -> Checks:
    """The drives of a file, if they were made with what there is here; else none."""
    if out is None or not out.exists():
        return here
    before = read_json(Checks, out)
    if before.is_like(here):
        return before
    click.echo(
        f"{out} was made with another code, car, town or machine: all is driven again.", err=True
    )
    return here


def told(checks: Checks, clock: Clock) -> bool:
    """Print the tables and whatever is not as it should be; whether all is."""
    found = bars(checks.drives, clock=clock)
    tables = [make(checks.drives) for make in (laps_table, comfort_table, times_table)]
    print(provenance(checks), *tables, bars_table(found), "", sep="\n\n")
    failures = [f"{it.job.name}: {it.flaw}" for it in checks.drives if it.flaw]
    failures += [str(it) for it in found if not it.holds and not it.is_open]
    for it in found:
        if it.is_open and not it.holds:
            print(f"Known, and not counted: {it}.")
    if {it.expert for it in checks.drives} == {"mpc"}:
        print("Smoothness was not compared: add --expert pid.")
    print("\n".join(failures or ["Everything else is as it should be."]))
    return not failures


if __name__ == "__main__":
    main()
