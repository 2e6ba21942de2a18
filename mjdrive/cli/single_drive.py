"""`mjdrive drive` without --episodes: one drive, its figures and its pictures."""

from pathlib import Path

from mjdrive.cli import filming
from mjdrive.cli.console import closing_table, progress_bars
from mjdrive.cli.driver import Driver
from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation import report
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.recording.playback import Playback
from mjdrive.simulation.simulation import Simulation
from mjdrive.vehicle.cars import CarModel


def drive_once(
    driver: Driver,
    town: Town,
    folder: Path,
    *,
    car: CarModel,
    num_steps: int,
    seed: int,
    is_filmed: bool,
) -> None:
    """Make one drive, write it and its figures, and say what came of it.

    Args:
        driver: Who drives.
        town: Where.
        folder: New folder for the drive.
        car: Which car.
        num_steps: Control steps [-].
        seed: Same seed, same drive.
        is_filmed: Whether to write a video, too.

    Raises:
        DataError: If the folder holds something.
        RenderError: If a video is asked for and there is no OpenGL here.
    """
    if is_filmed:
        filming.require_cameras()
    report.require_new(folder)
    late_plans: list[int] = []
    with progress_bars() as bars:
        task = bars.add_task(f"{driver.name} in {town.name}", total=num_steps)
        episode = driver.drive(
            Simulation(town, car=car),
            num_steps=num_steps,
            seed=seed,
            on_step=lambda done: bars.update(task, completed=done),
            on_late_plans=late_plans.append,
        )
    summary = report.write_drive(episode, town, folder)
    closing_table(
        f"{driver.name} in {town.name}, seed {seed}",
        {
            "car": driver.car_note(car),
            **_figures(summary),
            **driver.solve_notes(episode, sum(late_plans)),
            "path": folder / "trajectory.png",
            "actions": folder / "actions.png",
            **(_filmed(episode, driver, folder, car) if is_filmed else {}),
            "figures": folder / report.SUMMARY,
            "episode": folder / report.EPISODE,
        },
        next_command=f"mjdrive drive --town {town.name} --policy pid --seed {seed}"
        if driver.pilot is not None
        else f"mjdrive drive --town {town.name} --policy {driver.name} --seed {seed + 1}",
    )


def _figures(summary: DriveSummary) -> dict[str, object]:
    """What a drive is worth, by what the closing table calls it."""
    rms = summary.lane_keeping.offset_rms_m
    return {
        "distance": f"{summary.distance_m:,.1f} m in {summary.duration_s:,.1f} s",
        "red lights": summary.red_lights,
        "collisions": summary.collisions,
        "off road": f"{summary.road_departures} times, {summary.off_road_s:.1f} s",
        "wrong way": summary.wrong_ways,
        "stuck": f"{summary.standstills} times",
        # Nothing is known of a car that never moved along a lane.
        "off the lane's middle": "not known"
        if rms is None
        else f"{rms:.2f} m RMS outside junctions",
        "score": f"{summary.score:,.1f}",
    }


def _filmed(episode: Episode, driver: Driver, folder: Path, car: CarModel) -> dict[str, object]:
    """Write the video of a drive, and say where it is."""
    path = folder / filming.VIDEO
    playback = Playback(episode, car=str(car.path))
    filming.write_video(playback, path, landscape=filming.landscape_of(driver))
    return {"video": path}
