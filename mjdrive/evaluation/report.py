"""The folder that a drive leaves behind."""

import datetime
from pathlib import Path

from mjdrive import config
from mjdrive.datatypes import Episode, Town
from mjdrive.episodes import store
from mjdrive.errors import DataError
from mjdrive.evaluation import figures, timelines
from mjdrive.evaluation.metrics import DriveSummary, summarise

EPISODE = "episode.hdf5"
"""The drive itself."""

SUMMARY = "summary.json"
"""The figures of a drive, written after all else."""

TRAJECTORY = "trajectory.png"
ACTIONS = "actions.png"

FILES = (EPISODE, TRAJECTORY, ACTIONS, SUMMARY)
"""All files of a drive, in the order of writing."""


def write_drive(episode: Episode, town: Town, folder: Path) -> DriveSummary:
    """Write a drive, its pictures and, last of all, its figures.

    Args:
        episode: The drive.
        town: The town that it was driven in.
        folder: New folder for `episode.hdf5`, `trajectory.png`, `actions.png` and `summary.json`.

    Returns:
        The figures of the drive.

    Raises:
        DataError: If the folder is there already.
    """
    require_new(folder)
    summary = summarise(episode, town)
    store.write(episode, folder / EPISODE)
    figures.draw_trajectory(episode, town, folder / TRAJECTORY)
    timelines.draw_actions(episode, town, folder / ACTIONS)
    config.write_json(summary, folder / SUMMARY)
    return summary


def require_new(folder: Path) -> None:
    """Refuse to write into a folder that holds something.

    Raises:
        DataError: If the folder is a file or not empty.
    """
    if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise DataError(
            f"'{folder}' is there already. Expected a new folder: drives are never overwritten. "
            f"Give another one with --out."
        )


def new_folder(parent: Path, now: datetime.datetime) -> Path:
    """Name a folder after the time, as 2026-11-22T10-15-30; the second of one second gets -2.

    Args:
        parent: Where the folder will be.
        now: The time.
    """
    stamp = now.strftime("%Y-%m-%dT%H-%M-%S")
    folder, count = parent / stamp, 1
    while folder.exists():
        count += 1
        folder = parent / f"{stamp}-{count}"
    return folder
