import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from mjdrive.datatypes import Episode, Infraction, InfractionKind, Town
from mjdrive.episodes import dataset, store
from mjdrive.episodes.dataset import Manifest
from mjdrive.errors import DataError, UnknownNameError


def make_episode(steps: int) -> Episode:
    return Episode(
        town="town02",
        policy="pid",
        seed=0,
        light_phase=0.0,
        time=0.1 * np.arange(steps),
        physics=np.zeros((steps, 2)),
        vehicle=np.zeros((steps, 6)),
        actions=np.zeros((steps, 2)),
        labels=np.zeros((steps, 2)),
        on_lane=np.ones(steps, bool),
        infractions=(Infraction(InfractionKind.KERB, 0.1, 0.0, 0.0, "kerb"),) * 2,
        metadata={},
    )


@pytest.fixture
def folder(tmp_path: Path, town02: Town) -> Path:
    """A data set of two episodes."""
    entries = []
    for index in (0, 1):
        episode, file = make_episode(5 + index), f"e{index}.hdf5"
        store.write(episode, tmp_path / file)
        content = (tmp_path / file).read_bytes()
        entries.append(dataset.describe(episode, name=f"e{index}", file=file, content=content))
    manifest = Manifest(
        town="town02",
        town_digest=town02.digest,
        seed=0,
        settings={"repeats": 1, "disturbance": None},
        versions={"mjdrive": "0.1.0"},
        num_planned=2,
        episodes=tuple(entries),
    )
    dataset.write_manifest(manifest, tmp_path)
    return tmp_path


def change(folder: Path, **values: object) -> None:
    path = folder / dataset.MANIFEST
    path.write_text(json.dumps(json.loads(path.read_text()) | values))


def test_read_gives_what_was_written(folder: Path) -> None:
    manifest, episodes = dataset.read_dataset(folder)
    assert [len(episode.time) for episode in episodes] == [5, 6]
    assert [entry.steps for entry in manifest.episodes] == [5, 6]
    assert manifest.episodes[0].infractions == {"kerb": 2}
    assert manifest.settings == {"repeats": 1, "disturbance": None}


def test_missing_folder_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"does not exist.*mjdrive collect --town town01"):
        dataset.read_dataset(tmp_path / "absent")


def test_folder_without_manifest_is_no_data_set(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="is no data set"):
        dataset.read_dataset(tmp_path)


def test_data_of_another_map_are_refused(folder: Path) -> None:
    change(folder, town_digest="0" * 64)
    with pytest.raises(DataError, match=r"another map or town format.*--overwrite"):
        dataset.read_dataset(folder)


def test_data_of_an_unknown_town_are_refused(folder: Path) -> None:
    change(folder, town="town2")
    with pytest.raises(UnknownNameError, match="Did you mean 'town02'"):
        dataset.read_dataset(folder)


def test_unfinished_data_are_refused(folder: Path) -> None:
    change(folder, num_planned=3)
    with pytest.raises(DataError, match=r"2 of 3 episodes.*goes on"):
        dataset.read_dataset(folder)


def test_other_format_is_refused(folder: Path) -> None:
    change(folder, format="mjdrive-dataset-0")
    with pytest.raises(DataError, match="'mjdrive-dataset-0'; expected 'mjdrive-dataset-1'"):
        dataset.read_dataset(folder)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"town": "town02"}', '{"colour": "red"}'])
def test_damaged_manifest_is_refused(folder: Path, text: str) -> None:
    (folder / dataset.MANIFEST).write_text(text)
    with pytest.raises(DataError, match=r"manifest\.json"):
        dataset.read_dataset(folder)


def test_truncated_episode_is_refused_by_name(folder: Path) -> None:
    path = folder / "e1.hdf5"
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(DataError, match=r"e1\.hdf5"):
        dataset.read_dataset(folder)


def test_exchanged_episode_is_refused(folder: Path) -> None:
    (folder / "e1.hdf5").write_bytes((folder / "e0.hdf5").read_bytes())
    with pytest.raises(DataError, match=r"e1\.hdf5' is not the file that manifest\.json lists"):
        dataset.read_dataset(folder)


def test_digest_changes_with_any_episode(folder: Path) -> None:
    before = dataset.digest(folder)
    manifest = dataset.read_manifest(folder)
    entry = dataclasses.replace(manifest.episodes[0], sha256="0" * 64)
    dataset.write_manifest(
        dataclasses.replace(manifest, episodes=(entry, manifest.episodes[1])), folder
    )
    assert dataset.digest(folder) != before


def test_remove_leaves_strangers_alone(folder: Path) -> None:
    (folder / "notes.txt").write_text("mine")
    (folder / "unlisted.hdf5").write_bytes(b"mine")
    dataset.remove(folder)
    assert {path.name for path in folder.iterdir()} == {"notes.txt", "unlisted.hdf5"}
    (folder / "other.hdf5").write_bytes(b"not ours: there is no manifest")
    dataset.remove(folder)
    assert (folder / "other.hdf5").exists()


def test_remove_deletes_nothing_outside_the_folder(folder: Path) -> None:
    stranger = folder.parent / "stranger.hdf5"
    stranger.write_bytes(b"mine")
    entries = json.loads((folder / dataset.MANIFEST).read_text())["episodes"]
    change(folder, episodes=[{**entries[0], "file": "../stranger.hdf5"}])
    dataset.remove(folder)
    assert stranger.exists()


def test_remove_deletes_nothing_if_the_manifest_cannot_be_read(folder: Path) -> None:
    (folder / dataset.MANIFEST).write_text("{")
    with pytest.raises(DataError, match=r"delete '.*' yourself, or give another folder"):
        dataset.remove(folder)
    assert {path.name for path in folder.iterdir()} == {"manifest.json", "e0.hdf5", "e1.hdf5"}
