import os
import time
from pathlib import Path

from mjdrive.town.town_folder import UNFINISHED, new_town_folder

DAY = 24 * 3600.0


def hidden_folder(path: Path, *, age: float) -> Path:
    """A folder with a file in it that was written some time ago [s]."""
    path.mkdir()
    (path / "half of a map").touch()
    then = time.time() - age
    os.utime(path, (then, then))
    return path


def test_a_town_takes_its_place_whole_and_leaves_nothing_beside_it(tmp_path: Path) -> None:
    with new_town_folder("new", parent=tmp_path) as folder:
        assert folder.parent.name.startswith(UNFINISHED)
        (folder / "map.xodr").touch()
        assert not (tmp_path / "new").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["new"]
    assert (tmp_path / "new" / "map.xodr").is_file()


def test_what_killed_commands_left_is_swept_away_and_nothing_else(tmp_path: Path) -> None:
    left = hidden_folder(tmp_path / f"{UNFINISHED}left", age=2.0 * DAY)
    at_work = hidden_folder(tmp_path / f"{UNFINISHED}at-work", age=60.0)
    of_the_user = hidden_folder(tmp_path / ".mine", age=2.0 * DAY)
    with new_town_folder("new", parent=tmp_path):
        assert not left.exists()
        assert at_work.is_dir()
        assert of_the_user.is_dir()
