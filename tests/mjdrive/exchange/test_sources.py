from pathlib import Path

import pytest

from mjdrive.datatypes import Episode
from mjdrive.episodes import store
from mjdrive.errors import DataError
from mjdrive.exchange import sources


def names(source: Path) -> list[str]:
    return [it.name for it in sources.read(source)]


def test_files_drives_and_folders_of_either_are_found(tmp_path: Path, short_drive: Episode) -> None:
    for file in ("drives/b/episode.hdf5", "drives/a/episode.hdf5", "data/first-0.hdf5"):
        store.write(short_drive, tmp_path / file)
    assert names(tmp_path / "drives/a/episode.hdf5") == ["a"]
    assert names(tmp_path / "drives/b") == ["b"]
    assert names(tmp_path / "drives") == ["a", "b"]
    assert names(tmp_path / "data") == ["first-0"]


def test_a_place_without_episodes_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="holds no episode"):
        sources.find(tmp_path)
    with pytest.raises(DataError, match="does not exist"):
        sources.find(tmp_path / "nowhere")


def test_what_is_no_episode_is_refused_by_its_name(tmp_path: Path) -> None:
    (tmp_path / "x.hdf5").write_bytes(b"nothing")
    with pytest.raises(DataError, match=r"x\.hdf5' is no whole episode"):
        sources.read(tmp_path)
