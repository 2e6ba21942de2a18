"""`mjdrive drive --episodes N`: many drives of one policy, and what they are worth on average."""

from pathlib import Path

from rich.markup import escape

from mjdrive import config, versions
from mjdrive.cli.console import closing_table, ended_by_sigterm, episode_bars
from mjdrive.cli.driver import Driver
from mjdrive.cli.solving import late_row
from mjdrive.datatypes import Town
from mjdrive.episodes import store
from mjdrive.evaluation import report, spread
from mjdrive.evaluation.drives import Driving, make_drives, plan_drives, require_same_drives
from mjdrive.evaluation.figures import MOST_MAPS, draw_dataset
from mjdrive.execution.work import Executor
from mjdrive.vehicle.cars import CarModel


def drive_episodes(
    driver: Driver,
    town: Town,
    folder: Path,
    *,
    car: CarModel,
    num_steps: int,
    num_episodes: int,
    seed: int,
    executor: Executor,
) -> None:
    """Make the drives that are missing in a folder, average them all and draw them.

    Args:
        driver: Who drives.
        town: Where.
        folder: Gets a folder for each drive; it may hold some of the same drives already.
        car: Which car.
        num_steps: Control steps of each drive [-].
        num_episodes: How many drives [-].
        seed: Decides the seed of each drive.
        executor: Where they are made.

    Raises:
        DataError: If the folder holds something else.
        WorkerError: If a process or machine that drove was lost, or has other versions than this one.
    """
    description = {
        "town": town.name,
        "policy": driver.name,
        "seed": str(seed),
        **driver.metadata(town, car, num_steps),
    }
    require_same_drives(folder, description)
    planned = plan_drives(num_episodes, seed=seed)
    work = Driving(driver, town, car, num_steps, versions.all_versions())
    late_plans: list[int] = []
    name = f"{driver.name} in {town.name}"
    with ended_by_sigterm(), episode_bars(name, total=num_episodes) as progress:
        drives = make_drives(
            work,
            planned,
            folder,
            description=description,
            executor=executor,
            report_progress=progress,
            on_late_plans=late_plans.append,
        )
    summary = spread.summarise_drives(drives, town)
    shown = {
        drive.name: store.read(folder / drive.name / report.EPISODE)
        for drive in planned[:MOST_MAPS]
    }
    draw_dataset(shown, town, folder / "trajectories.png")
    spread.draw_spread(drives, folder / "spread.png")
    config.write_json(summary, folder / report.SUMMARY)
    mpc = None if driver.expert is None else driver.expert.mpc
    late = {} if mpc is None else late_row(sum(late_plans), mpc.late_after, mpc.late_plan)
    closing_table(
        f"{name}, {num_episodes} drives of {num_steps:,} steps, seed {seed}",
        {
            "car": driver.car_note(car),
            **{escape(title): summary.figures[name] for name, title in spread.FIGURES.items()},
            "branches, all drives": f"{len(summary.branches_taken)} of {summary.branches}",
            "clean drives": f"{summary.clean} of {summary.episodes}",
            **(late if driver.name == "mpc" else {}),
            "paths": folder / "trajectories.png",
            "spread": folder / "spread.png",
            "figures": folder / report.SUMMARY,
            "drives": folder / planned[0].name,
        },
        next_command=f"mjdrive drive --town {town.name} --policy pid --episodes {num_episodes} --seed {seed}"
        if driver.pilot is not None
        else f"mjdrive drive --town {town.name} --policy {driver.name} --episodes {2 * num_episodes} --seed {seed} --out {folder}",
    )
