"""`mjdrive drive`: let a policy drive freely through a town."""

from pathlib import Path

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
    car_name: str,
    gains: Path | None,
    solver: str | None,
    fallback_solver: str | None,
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

    from mjdrive.cli.console import closing_table, progress_bars
    from mjdrive.cli.driver import find_driver
    from mjdrive.evaluation import report
    from mjdrive.simulation.simulation import Simulation
    from mjdrive.town import library
    from mjdrive.vehicle import cars

    car = cars.load(car_name)
    town = library.load(town_name)
    driver = find_driver(
        policy_name, RUNS, preset=preset, on_note=lambda note: click.echo(note, err=True)
    )
    if gains is not None:
        driver = driver.tuned(gains, car)
    driver = driver.solved_by(solver, fallback_solver)
    folder = out or report.new_folder(DRIVES, datetime.datetime.now())
    if is_filmed:
        from mjdrive.cli import filming

        _require_one(num_episodes)
        filming.require_cameras()
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
    report.require_new(folder)
    late_solves: list[int] = []
    with progress_bars() as bars:
        task = bars.add_task(f"{driver.name} in {town.name}", total=num_steps)
        episode = driver.drive(
            Simulation(town, car=car),
            num_steps=num_steps,
            seed=seed,
            on_step=lambda done: bars.update(task, completed=done),
            on_late_solves=late_solves.append,
        )
    summary = report.write_drive(episode, town, folder)
    video: dict[str, object] = {}
    if is_filmed:
        from mjdrive.recording.playback import Playback

        video = {"video": folder / filming.VIDEO}
        playback = Playback(episode, car=car_name)
        landscape = filming.landscape_of(driver)
        filming.write_video(playback, folder / filming.VIDEO, landscape=landscape)
    closing_table(
        f"{driver.name} in {town.name}, seed {seed}",
        {
            "car": driver.car_note(car),
            "distance": f"{summary.distance_m:,.1f} m in {summary.duration_s:,.1f} s",
            "red lights": summary.red_lights,
            "collisions": summary.collisions,
            "off road": f"{summary.road_departures} times, {summary.off_road_s:.1f} s",
            "wrong way": summary.wrong_ways,
            "stuck": f"{summary.standstills} times",
            "off the lane's middle": _offset(summary.lane_keeping.offset_rms_m),
            "score": f"{summary.score:,.1f}",
            **driver.solve_notes(episode, sum(late_solves)),
            "path": folder / "trajectory.png",
            "actions": folder / "actions.png",
            **video,
            "figures": folder / "summary.json",
            "episode": folder / "episode.hdf5",
        },
        next_command=f"mjdrive drive --town {town.name} --policy pid --seed {seed}"
        if driver.pilot is not None
        else f"mjdrive drive --town {town.name} --policy {driver.name} --seed {seed + 1}",
    )


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


def _offset(rms: float | None) -> str:
    """Say how well the lane was kept; nothing is known of a car that never moved along one."""
    return "not known" if rms is None else f"{rms:.2f} m RMS outside junctions"
