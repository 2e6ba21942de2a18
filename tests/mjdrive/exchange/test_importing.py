import dataclasses
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.episodes import dataset, store
from mjdrive.errors import DataError, UnknownNameError
from mjdrive.exchange import from_minari, importing
from mjdrive.exchange.importing import IMPORTED
from mjdrive.exchange.minari import MAIN, METADATA
from mjdrive.exchange.sources import Recording


def minari_set(folder: Path, **arrays: np.ndarray) -> Path:
    """A Minari data set of one episode, of whatever somebody recorded."""
    folder.mkdir(parents=True)
    (folder / METADATA).write_text("{}")
    with h5py.File(folder / MAIN, "w") as file:
        group = file.create_group("episode_0")
        for name, array in arrays.items():
            group[name.replace("__", "/")] = array
    return folder


def test_what_is_exported_comes_back_bit_by_bit_and_can_be_learnt_from(
    exported: Callable[[str], Path], recordings: list[Recording], tmp_path: Path
) -> None:
    read = from_minari.read(exported("minari"))
    importing.write(read, tmp_path / "data", origin="minari x")
    manifest, episodes = dataset.read_dataset(tmp_path / "data")
    assert [it.name for it in manifest.episodes] == ["bad", "good"]
    for back, meant in zip(episodes, recordings, strict=True):
        metadata = {**meant.episode.metadata, IMPORTED: "minari x"}
        expected = dataclasses.replace(meant.episode, metadata=metadata)
        assert store.to_bytes(back) == store.to_bytes(expected)


def test_poses_alone_will_do_and_what_is_not_known_is_left_open(
    tmp_path: Path, recordings: list[Recording]
) -> None:
    episode = recordings[1].episode
    folder = minari_set(
        tmp_path / "poses",
        infos__time=episode.time,
        infos__vehicle=episode.vehicle,
        actions=episode.actions[:-1].astype(np.float32),
    )
    with h5py.File(folder / MAIN, "a") as file:
        file["episode_0"].attrs.update({"town": "town02", "light_phase": 2.5})
    (read,) = from_minari.read(folder)
    steps = len(episode.time) - 1
    assert (read.name, read.episode.policy, read.episode.light_phase) == (
        "episode_0",
        "unknown",
        2.5,
    )
    assert read.episode.physics.shape == (steps, 0)
    np.testing.assert_array_equal(read.episode.vehicle, episode.vehicle[:-1])
    importing.write([read], tmp_path / "data", origin="poses")
    assert dataset.read_dataset(tmp_path / "data")[0].town == "town02"


def test_pictures_without_poses_are_refused_with_what_is_missing(tmp_path: Path) -> None:
    folder = minari_set(tmp_path / "set", observations=np.zeros((3, 4)), actions=np.zeros((2, 2)))
    with pytest.raises(
        DataError,
        match=r"has no town, light_phase, infos/time, infos/vehicle; it has .*observations",
    ):
        from_minari.read(folder)


def test_what_is_no_minari_data_set_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="is no Minari data set"):
        from_minari.read(tmp_path)
    (tmp_path / METADATA).write_text("{}")
    (tmp_path / MAIN).write_bytes(b"nothing")
    with pytest.raises(DataError, match="is no whole Minari file"):
        from_minari.read(tmp_path)


def test_drives_outside_their_town_or_of_two_towns_are_refused(
    tmp_path: Path, recordings: list[Recording]
) -> None:
    episode = recordings[1].episode
    flipped = episode.vehicle * np.array([1, -1, -1, 1, -1, -1]) + np.array([0, 2000, 0, 0, 0, 0])
    outside = Recording("outside", dataclasses.replace(episode, vehicle=flipped))
    with pytest.raises(DataError, match="never comes into town02"):
        importing.write([outside], tmp_path / "data", origin="x")
    other = Recording("other", dataclasses.replace(episode, town="town01"))
    with pytest.raises(DataError, match="'other' was driven in town01, others in town02"):
        importing.write([recordings[1], other], tmp_path / "data", origin="x")
    assert not list(tmp_path.iterdir())


def test_only_data_sets_are_overwritten_and_only_if_asked(
    tmp_path: Path, recordings: list[Recording]
) -> None:
    folder = tmp_path / "data"
    importing.write(recordings, folder, origin="x")
    with pytest.raises(DataError, match="is there already"):
        importing.write(recordings, folder, origin="x")
    importing.write(recordings[:1], folder, origin="x", overwrite=True)
    assert len(list(folder.iterdir())) == 2
    (folder / "letter.txt").write_text("dear")
    with pytest.raises(DataError, match=r"letter\.txt' belongs to no data set"):
        importing.write(recordings, folder, origin="x", overwrite=True)
    with pytest.raises(UnknownNameError, match="Did you mean 'minari'"):
        importing.known("minarii")


def test_the_command_says_what_to_do_next(
    exported: Callable[[str], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["import", "--from", "minari", str(exported("minari")), "--out", "data/theirs"]
    done = CliRunner().invoke(main, words, catch_exceptions=False)
    assert (done.exit_code, "mjdrive train da-ibc --data data/theirs" in done.stdout) == (0, True)
