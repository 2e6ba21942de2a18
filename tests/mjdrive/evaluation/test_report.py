import datetime
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mjdrive.datatypes import Episode, Town
from mjdrive.episodes import store
from mjdrive.errors import DataError
from mjdrive.evaluation import report

NOW = datetime.datetime(2026, 11, 22, 10, 15, 30)


def test_folder_holds_everything_about_the_drive(
    crossing: Town, make_drive: Callable[..., Episode], tmp_path: Path
) -> None:
    drive = make_drive(np.linspace(0, 50, 51))
    summary = report.write_drive(drive, crossing, tmp_path / "drive")
    assert summary.distance_m == 50.0
    assert {path.name for path in (tmp_path / "drive").iterdir()} == {
        "episode.hdf5",
        "trajectory.png",
        "actions.png",
        "summary.json",
    }
    np.testing.assert_array_equal(
        store.read(tmp_path / "drive/episode.hdf5").vehicle, drive.vehicle
    )


def test_drives_are_never_overwritten(
    crossing: Town, make_drive: Callable[..., Episode], tmp_path: Path
) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(DataError, match="is there already"):
        report.write_drive(make_drive(np.zeros(3)), crossing, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_folders_of_one_second_have_different_names(tmp_path: Path) -> None:
    names = []
    for _ in range(3):
        folder = report.new_folder(tmp_path, NOW)
        folder.mkdir()
        names.append(folder.name)
    assert names == ["2026-11-22T10-15-30", "2026-11-22T10-15-30-2", "2026-11-22T10-15-30-3"]
