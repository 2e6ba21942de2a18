"""`mjdrive drive`: let a policy drive freely through a town."""

from pathlib import Path
from typing import Literal

import rich_click as click

from mjdrive.cli.options import (
    Jobs,
    car_option,
    chosen_executor,
    executor_options,
    gains_option,
)
from mjdrive.cli.solving import solver_options

RUNS = Path("runs")
DRIVES = Path("drives")


def _list_shipped(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    """Print a table of the shipped policies, and nothing else, if that is asked for."""
    if value == "zoo:" and not ctx.resilient_parsing:
        from mjdrive.cli.policy_tables import shipped_table
        from mjdrive.zoo import entries

        shipped_table(entries.FOLDER)
        ctx.exit()
    return value


@click.command()
@click.option("--town", "town_name", required=True, metavar="NAME", help="Town to drive in.")
@click.option(
    "--steps",
    "num_steps",
    default=3000,
    show_default=True,
    type=click.IntRange(min=1),
    help="Control steps of 0.1 s.",
)
@click.option(
    "--policy",
    "policy_name",
    metavar="RUN|pid|mpc|zoo:NAME",
    is_eager=True,
    callback=_list_shipped,
    help="A run folder, the name of one in runs/, an expert, or a policy that comes with mjdrive; zoo: lists these. "
    "[default: the newest run, zoo:da-ibc where there is none]",
)
@click.option(
    "--preset",
    metavar="standard|quick|paper",
    help="How a trained policy chooses its actions. [default: as it was trained to]",
)
@click.option(
    "--set",
    "acting",
    multiple=True,
    metavar="NAME=VALUE",
    help="Change one setting of how it does, as commitment.hold=0. May be given again.",
)
@car_option
@gains_option
@solver_options
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**32 - 1),
    help="Same seed, same drive.",
)
@click.option(
    "--episodes",
    "num_episodes",
    type=click.IntRange(min=1),
    metavar="N",
    help="Make N drives, each with a seed of its own that --seed decides, and average them.",
)
@executor_options
@click.option(
    "--video",
    "is_filmed",
    is_flag=True,
    help="Write a video, too: cameras, bird's-eye view, energy landscape and map. Needs OpenGL; takes several times as long as the drive.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="New folder for the drive; with --episodes, one whose drives to go on with, too. [default: drives/<date and time>]",
)
def drive(
    *,
    town_name: str,
    num_steps: int,
    policy_name: str | None,
    preset: str | None,
    acting: tuple[str, ...],
    car_name: str,
    gains: Path | None,
    solver: str | None,
    fallback_solver: str | None,
    late_plan: Literal["plan", "pid"] | None,
    seed: int,
    num_episodes: int | None,
    jobs: Jobs,
    backend: str,
    address: str | None,
    is_filmed: bool,
    out: Path | None,
) -> None:
    """Drive freely through a town, from a random place and with no route.

    Writes the episode, its figures and two pictures. With --episodes, each drive gets a folder of its own, and mean and
    standard deviation of the figures are written beside them; an interrupted command can be run again and goes on.
    """
    import datetime

    from mjdrive.cli.driver import find_driver
    from mjdrive.episodes.presets import SolverChoice
    from mjdrive.evaluation import report
    from mjdrive.town import library
    from mjdrive.vehicle import cars

    car = cars.load(car_name)
    town = library.load(town_name)
    driver = find_driver(
        policy_name,
        RUNS,
        preset=preset,
        acting=acting,
        on_note=lambda note: click.echo(note, err=True),
    )
    if gains is not None:
        driver = driver.tuned(gains, car)
    driver = driver.solved_by(SolverChoice(solver, fallback_solver, late_plan))
    folder = out or report.new_folder(DRIVES, datetime.datetime.now())
    if is_filmed:
        _require_one(num_episodes)
    if num_episodes is not None:
        from mjdrive.cli.drives import drive_episodes

        drive_episodes(
            driver,
            town,
            folder,
            car=car,
            num_steps=num_steps,
            num_episodes=num_episodes,
            seed=seed,
            executor=chosen_executor(jobs, backend, address),
        )
        return
    _require_alone(jobs, backend, address)
    from mjdrive.cli.single_drive import drive_once

    drive_once(driver, town, folder, car=car, num_steps=num_steps, seed=seed, is_filmed=is_filmed)


def _require_one(num_episodes: int | None) -> None:
    """Refuse to film many drives."""
    from mjdrive.errors import ConfigError

    if num_episodes is not None:
        raise ConfigError(
            "--video films one drive; expected it without --episodes. Film one of many when they are made: "
            "`mjdrive replay DIR/episode-000`."
        )


def _require_alone(jobs: Jobs, backend: str, address: str | None) -> None:
    """Refuse options for several drives where there is one."""
    from mjdrive.errors import ConfigError

    if jobs not in (None, 1) or backend != "local" or address is not None:
        raise ConfigError(
            "--jobs, --backend and --address share out several drives; expected --episodes N with them. "
            "A single drive is made here, one step after the other."
        )
