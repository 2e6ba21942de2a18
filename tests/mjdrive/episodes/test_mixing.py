import dataclasses
from pathlib import Path

import pytest

from mjdrive.datatypes import Town
from mjdrive.episodes import dataset
from mjdrive.episodes.manifest import Collection, EpisodeEntry
from mjdrive.episodes.mixing import find_place
from mjdrive.errors import DataError

CLEAN = Collection(
    seed=0,
    settings={"disturbance": None, "repeats": 1},
    versions={"mjdrive": "1"},
    car="default",
    car_digest="d",
    num_planned=2,
)
NOISY = dataclasses.replace(CLEAN, settings={"disturbance": {"stop_brake": 0.4}, "repeats": 1})
ENTRY = EpisodeEntry("route0-0", "route0-0.hdf5", "0" * 64, 5, {})


@pytest.fixture
def folder(tmp_path: Path, town02: Town) -> Path:
    """A data set of one collection that is half driven."""
    manifest, _ = find_place(tmp_path / "data", town02, CLEAN, mix=False)
    dataset.write_manifest(dataclasses.replace(manifest, episodes=(ENTRY,)), tmp_path / "data")
    return tmp_path / "data"


def test_new_folder_begins_with_the_collection(tmp_path: Path, town02: Town) -> None:
    manifest, number = find_place(tmp_path / "new", town02, CLEAN, mix=False)
    assert (manifest.collections, number, manifest.all_planned) == ((CLEAN,), 0, 2)
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("mix", [False, True])
def test_same_collection_goes_on_whether_or_not_it_may_mix(
    folder: Path, town02: Town, mix: bool
) -> None:
    manifest, number = find_place(folder, town02, CLEAN, mix=mix)
    assert (number, manifest.episodes, manifest.added) == (0, (ENTRY,), ())


def test_other_settings_are_refused_by_name_unless_told(folder: Path, town02: Town) -> None:
    with pytest.raises(DataError, match=r"differs in settings \(disturbance\)\..*--mix"):
        find_place(folder, town02, NOISY, mix=False)
    manifest, number = find_place(folder, town02, NOISY, mix=True)
    assert (number, manifest.collections, manifest.all_planned) == (1, (CLEAN, NOISY), 4)


def test_all_that_differs_is_named(folder: Path, town02: Town) -> None:
    other = dataclasses.replace(NOISY, seed=3, versions={"mjdrive": "2"}, car="mkz")
    with pytest.raises(
        DataError, match=r"seed, settings \(disturbance\), versions \(mjdrive\), car\."
    ):
        find_place(folder, town02, other, mix=False)


def test_mixed_collection_is_found_again(folder: Path, town02: Town) -> None:
    mixed, _ = find_place(folder, town02, NOISY, mix=True)
    dataset.write_manifest(mixed, folder)
    assert dataset.read_manifest(folder) == mixed
    for collection, number in ((CLEAN, 0), (NOISY, 1)):
        assert find_place(folder, town02, collection, mix=False) == (mixed, number)


def test_towns_are_never_mixed(folder: Path, town01: Town, town02: Town) -> None:
    with pytest.raises(DataError, match=r"differs in town, town_digest\. Expected one of town01"):
        find_place(folder, town01, CLEAN, mix=True)
    changed = dataclasses.replace(town02, digest="other")
    with pytest.raises(DataError, match=r"differs in town_digest\."):
        find_place(folder, changed, CLEAN, mix=True)
