"""`mjdrive collect`: let an expert drive the routes of a town, or take random turns."""

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


@click.command()
@click.option("--town", "town_name", required=True, metavar="NAME", help="Town to drive in.")
@click.option(
    "--preset",
    default="standard",
    show_default=True,
    metavar="standard|paper|quick",
    help="What is driven: every route disturbed (standard), undisturbed (paper), or a few routes (quick).",
)
@click.option(
    "--routes",
    "route_names",
    metavar="NAME,NAME|0-4",
    help="Routes to drive, by name, by number, or from one number to another. [default: as the preset says]",
)
@click.option(
    "--random-walk",
    "random_walk_km",
    type=float,
    metavar="KM",
    help="Drive so far with random turns instead of along the routes, in episodes of 1 km.",
)
@click.option(
    "--episodes",
    type=click.IntRange(min=1),
    metavar="N",
    help="Drive N episodes: the routes in turn, again and again, or the random walk in N pieces.",
)
@click.option(
    "--expert",
    default="pid",
    show_default=True,
    metavar="pid|mpc",
    help="Who drives.",
)
@solver_options
@click.option(
    "--noise",
    type=float,
    metavar="SCALE",
    help="Scale of the disturbances, 0 to 2: 0 drives cleanly, 1 is the standard. The clean action stays the label.",
)
@click.option(
    "--throttle-noise",
    type=float,
    metavar="SCALE",
    help="Scale of pulses on throttle and brake, 0 to 2, as often as the paper's code has them. [default: 0]",
)
@car_option
@gains_option
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**32 - 1),
    help="Same seed, same files.",
)
@executor_options
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Data folder. [default: data/<town>]",
)
@click.option("--overwrite", is_flag=True, help="Replace a data set that is in the folder.")
@click.option("--mix", is_flag=True, help="Add to a data set that was driven in another way.")
def collect(
    *,
    town_name: str,
    preset: str,
    route_names: str | None,
    random_walk_km: float | None,
    episodes: int | None,
    expert: str,
    solver: str | None,
    fallback_solver: str | None,
    late_plan: Literal["plan", "pid"] | None,
    noise: float | None,
    throttle_noise: float | None,
    car_name: str,
    gains: Path | None,
    seed: int,
    jobs: Jobs,
    backend: str,
    address: str | None,
    out: Path | None,
    overwrite: bool,
    mix: bool,
) -> None:
    """Collect demonstrations: an expert drives the routes of a town, or takes random turns.

    An interrupted collection can be run again and goes on.
    """
    from mjdrive.cli.collected import rows
    from mjdrive.cli.console import closing_table, ended_by_sigterm, episode_bars
    from mjdrive.cli.solving import late_row
    from mjdrive.episodes import dataset, presets
    from mjdrive.episodes.demonstrations import collect as collect_routes
    from mjdrive.episodes.plan import lay_routes, plan
    from mjdrive.errors import ConfigError
    from mjdrive.evaluation.figures import draw_dataset
    from mjdrive.town import library
    from mjdrive.tuning.gains import applied
    from mjdrive.vehicle import cars

    if overwrite and mix:
        raise ConfigError(
            "--overwrite replaces a data set and --mix adds to it; expected one of them."
        )
    car = cars.load(car_name)
    town = library.load(town_name)
    waypoints = library.load_settings(town_name).routes
    settings = presets.chosen(
        preset,
        routes=None if route_names is None else presets.route_names(route_names, waypoints),
        random_walk_km=random_walk_km,
        episodes=episodes,
        expert=expert,
        noise=noise,
        throttle_noise=throttle_noise,
    )
    if gains is not None:
        settings = applied(settings, gains, car)
    settings = presets.with_solver(
        settings, presets.SolverChoice(solver, fallback_solver, late_plan)
    )
    routes = lay_routes(town, waypoints, settings=settings)
    planned = plan(town, routes, settings=settings, seed=seed)
    executor = chosen_executor(jobs, backend, address)
    folder = out or Path("data") / town.name
    late_plans: list[int] = []
    with ended_by_sigterm(), episode_bars(town.name, total=len(planned)) as report:
        collect_routes(
            town,
            routes,
            folder,
            settings=settings,
            seed=seed,
            car=car,
            executor=executor,
            mix=mix,
            overwrite=overwrite,
            report=report,
            on_late_plans=late_plans.append,
        )
    manifest, driven = dataset.read_dataset(folder)
    drives = dict(zip((entry.name for entry in manifest.episodes), driven, strict=True))
    draw_dataset(drives, town, folder / "overview.png")
    closing_table(
        f"Demonstrations in {town.name}",
        {
            "folder": folder,
            **rows(manifest, driven, town),
            **(
                late_row(sum(late_plans), settings.mpc.late_after, settings.mpc.late_plan)
                if expert == "mpc"
                else {}
            ),
            "picture": folder / "overview.png",
        },
        next_command="mjdrive train da-ibc" + ("" if out is None else f" --data {folder}"),
    )
