"""`mjdrive collect`: let the expert drive the routes of a town."""

from pathlib import Path

import rich_click as click


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
    "--noise",
    type=click.FloatRange(0.0, 2.0),
    metavar="SCALE",
    help="Scale of the disturbances: 0 drives cleanly, 1 is the standard. The clean action stays the label.",
)
@click.option(
    "--car",
    "car_name",
    default="default",
    show_default=True,
    metavar="NAME|FILE.xml",
    help="A car that comes with mjdrive (default, mkz), or an MJCF file of your own.",
)
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**32 - 1),
    help="Same seed, same files.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Data folder. [default: data/<town>]",
)
@click.option("--overwrite", is_flag=True, help="Replace a data set that is in the folder.")
def collect(
    *,
    town_name: str,
    preset: str,
    noise: float | None,
    car_name: str,
    seed: int,
    out: Path | None,
    overwrite: bool,
) -> None:
    """Collect demonstrations: the expert drives the routes of a town.

    An interrupted collection can be run again and goes on.
    """
    import numpy as np
    from rich.progress import TaskID

    from mjdrive.cli.console import closing_table, progress_bars
    from mjdrive.episodes import dataset, presets
    from mjdrive.episodes.demonstrations import collect as collect_routes
    from mjdrive.evaluation.figures import draw_dataset
    from mjdrive.town import library
    from mjdrive.town.routing import route_through
    from mjdrive.vehicle import cars

    car = cars.load(car_name)
    settings = presets.collect_preset(preset)
    if noise is not None:
        settings = presets.with_noise(settings, noise)
    town = library.load(town_name)
    waypoints = library.load_settings(town_name).routes
    routes = {name: route_through(town, np.array(places)) for name, places in waypoints.items()}
    folder = out or Path("data") / town.name
    if overwrite:
        dataset.remove(folder)
    with progress_bars() as bars:
        num_planned = len(settings.routes or routes) * settings.repeats
        whole = bars.add_task(town.name, total=num_planned, unit="episodes")
        tasks: dict[str, TaskID] = {}

        def report(name: str, done: int, expected: int) -> None:
            if name not in tasks:
                tasks[name] = bars.add_task(name)
            bars.update(tasks[name], completed=done, total=expected)
            if done == expected:
                bars.advance(whole)

        collect_routes(town, routes, folder, settings=settings, seed=seed, car=car, report=report)
    manifest, episodes = dataset.read_dataset(folder)
    names = [entry.name for entry in manifest.episodes]
    draw_dataset(dict(zip(names, episodes, strict=True)), town, folder / "overview.png")
    num_steps = sum(entry.steps for entry in manifest.episodes)
    num_infractions = sum(sum(entry.infractions.values()) for entry in manifest.episodes)
    closing_table(
        f"Demonstrations in {town.name}",
        {
            "folder": folder,
            "episodes": len(manifest.episodes),
            "steps": f"{num_steps:,}",
            "infractions": num_infractions,
            "picture": folder / "overview.png",
        },
        next_command="mjdrive train da-ibc" + ("" if out is None else f" --data {folder}"),
    )
