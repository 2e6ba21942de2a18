"""How smoothly a route can be steered at all: the least steering whiteness that a lane error leaves room for.

The PID drives the route. Then the steering of the whole route is optimised at once, at the PID's own speeds and with
the model of the car that the MPC plans with: the smallest RMS rate of the command for which the car stays on its
lane and the RMS distance of its rear axle from the route stays within an allowance. It knows all of the route, has no
rack to wait for and no disturbance to meet, so nobody who drives at these speeds steers more smoothly. Who drives more
slowly can: --pace 0.8 asks for the bound at 0.8 of the speeds, too.

The problem is not convex, so a solver's answer is the least only near where it began. It begins twice, with the wheel held
to the bends of the route and with the wheel straight; the smaller answer counts and both are kept.

With --out each route is written as it is done; the same command goes on where it stopped.

Example: python scripts/steering_bound.py --pace 1 --pace 0.8 --out docs/experts/steering_bound.json
"""

import dataclasses
from pathlib import Path

import click

from mjdrive.cli.console import progress_bars
from mjdrive.cli.expert_tables import bounds_table
from mjdrive.cli.main import Script
from mjdrive.config import read_json, to_json
from mjdrive.evaluation.steering_bound import Bounds, bound_of
from mjdrive.files import write_atomically
from mjdrive.town import library
from mjdrive.versions import all_versions, code_digest


@click.command(cls=Script)
@click.option(
    "--route", "names", multiple=True, help="Town and route. [default: all of town01 and town02]"
)
@click.option("--allowance", default=0.25, show_default=True, help="RMS lane error allowed [m].")
@click.option(
    "--pace",
    "paces",
    multiple=True,
    type=float,
    default=(1.0,),
    show_default=True,
    help="Factor on the PID's speeds [-].",
)
@click.option("--out", type=click.Path(path_type=Path), help="JSON file for every route.")
def main(
    *, names: tuple[str, ...], allowance: float, paces: tuple[float, ...], out: Path | None
) -> None:
    """Print the PID's whiteness beside the least whiteness at its speeds."""
    names = names or tuple(
        f"{town}/{route}"
        for town in ("town01", "town02")
        for route in library.load_settings(town).routes
    )
    kept = Bounds(code_digest(), all_versions())
    if out is not None and out.exists():
        before = read_json(Bounds, out)
        kept = before if (before.code, before.versions) == (kept.code, kept.versions) else kept
    cases = {(pace, allowance) for pace in paces}
    found = {
        it.route: it
        for it in kept.bounds
        if cases == {(at.pace, at.allowance) for at in it.least[1::2]}
    }
    with progress_bars() as bars:
        task = bars.add_task("routes", total=len(names), unit="routes")
        for name in names:
            if name not in found:
                found[name] = bound_of(name, allowance=allowance, paces=paces)
            bars.advance(task)
            if out is not None:
                kept = dataclasses.replace(kept, bounds=tuple(found.values()))
                write_atomically(out, (to_json(kept)).encode())
    print(bounds_table(tuple(found[name] for name in names)))


if __name__ == "__main__":
    main()
