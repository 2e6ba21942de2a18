import dataclasses
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.datatypes import Episode, Infraction, InfractionKind
from mjdrive.episodes import store
from mjdrive.errors import DataError


def make_episode(steps: int = 20) -> Episode:
    random = np.random.default_rng(3)
    return Episode(
        town="town02",
        policy="pid",
        seed=3,
        light_phase=1.5,
        time=0.1 * np.arange(steps),
        physics=random.normal(size=(steps, 30)),
        vehicle=random.normal(size=(steps, 6)),
        actions=random.uniform(-1, 1, size=(steps, 2)),
        labels=random.uniform(-1, 1, size=(steps, 2)),
        on_lane=random.random(steps) < 0.9,
        infractions=(
            Infraction(InfractionKind.KERB, 0.3, 1.0, 2.0, "kerb/12"),
            Infraction(InfractionKind.OFF_ROAD, 0.4, -1.0, 2.0, ""),
        ),
        metadata={"b": "café", "a": "{}"},
    )


def assert_equal(first: Episode, second: Episode) -> None:
    for field in dataclasses.fields(Episode):
        left, right = getattr(first, field.name), getattr(second, field.name)
        if isinstance(left, np.ndarray):
            assert left.dtype == right.dtype
            np.testing.assert_array_equal(left, right)
        else:
            assert left == right


def test_read_undoes_write(tmp_path: Path) -> None:
    episode = make_episode()
    store.write(episode, tmp_path / "a.hdf5")
    assert_equal(store.read(tmp_path / "a.hdf5"), episode)


@pytest.mark.parametrize("steps", [0, 1])
def test_short_episodes_survive(steps: int) -> None:
    episode = make_episode(steps)
    assert_equal(store.from_bytes(store.to_bytes(episode), name="short"), episode)


def test_no_infractions_survive() -> None:
    episode = make_episode()
    clean = dataclasses.replace(episode, infractions=())
    assert store.from_bytes(store.to_bytes(clean), name="clean").infractions == ()


def test_equal_episodes_have_equal_bytes_in_another_process(tmp_path: Path) -> None:
    store.write(make_episode(), tmp_path / "here.hdf5")
    program = (
        "import pathlib; from mjdrive.episodes import store; "
        "store.write(store.read(pathlib.Path('here.hdf5')), pathlib.Path('there.hdf5'))"
    )
    subprocess.run([sys.executable, "-c", program], cwd=tmp_path, check=True)
    assert (tmp_path / "there.hdf5").read_bytes() == (tmp_path / "here.hdf5").read_bytes()


def test_order_of_metadata_does_not_change_the_bytes() -> None:
    episode = make_episode()
    reordered = dataclasses.replace(episode, metadata=dict(reversed(episode.metadata.items())))
    assert store.to_bytes(reordered) == store.to_bytes(episode)


def test_layout_is_robomimics(tmp_path: Path) -> None:
    store.write(make_episode(7), tmp_path / "a.hdf5")
    with h5py.File(tmp_path / "a.hdf5", "r") as file:
        assert file["data"].attrs["total"] == 7
        demo = file["data/demo_0"]
        assert demo.attrs["num_samples"] == 7
        assert {"actions", "states", "dones", "obs"} <= set(demo)
        assert demo["dones"][()].tolist() == [0, 0, 0, 0, 0, 0, 1]


CONTENT = store.to_bytes(make_episode())


@given(st.integers(0, len(CONTENT) - 1))
def test_truncated_file_is_refused(length: int) -> None:
    with pytest.raises(DataError, match=r"'cut\.hdf5' is no whole episode file"):
        store.from_bytes(CONTENT[:length], name="cut.hdf5")


@given(st.integers(0, len(CONTENT) - 1), st.integers(1, 255))
def test_damaged_byte_is_refused_or_without_effect(position: int, flip: int) -> None:
    damaged = bytearray(CONTENT)
    damaged[position] ^= flip
    try:
        episode = store.from_bytes(bytes(damaged), name="damaged.hdf5")
    except DataError as error:
        assert "damaged.hdf5" in str(error)  # noqa: PT017 - either outcome is right
    else:
        assert_equal(episode, make_episode())


def test_foreign_hdf5_is_refused(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "other.hdf5", "w") as file:
        file["data/demo_0/actions"] = np.zeros((3, 2))
    with pytest.raises(DataError, match="episode format 'none'; expected 'mjdrive-episode-2'"):
        store.read(tmp_path / "other.hdf5")


def test_episode_of_an_older_format_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "old.hdf5"
    store.write(make_episode(), path)
    with h5py.File(path, "r+") as file:
        file.attrs["format"] = np.bytes_(b"mjdrive-episode-1")
    expected = r"old\.hdf5' has episode format 'mjdrive-episode-1'.*Drive or collect it again"
    with pytest.raises(DataError, match=expected):
        store.read(path)


def test_missing_file_says_what_makes_one(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"absent\.hdf5.*mjdrive collect"):
        store.read(tmp_path / "absent.hdf5")


def test_infraction_kinds_keep_their_numbers() -> None:
    # Files hold the numbers, so these are part of the format.
    assert [kind.name for kind in sorted(InfractionKind)] == [
        "RED_LIGHT",
        "COLLISION",
        "OFF_ROAD",
        "KERB",
        "WRONG_WAY",
        "STUCK",
    ]
    assert Infraction.__slots__ == ("kind", "time", "x", "y", "cause")


def test_labels_that_are_the_actions_are_kept_once(tmp_path: Path) -> None:
    episode = make_episode(500)
    clean = dataclasses.replace(episode, labels=episode.actions)
    assert len(store.to_bytes(clean)) < len(store.to_bytes(episode)) - 500 * 8
    assert_equal(store.from_bytes(store.to_bytes(clean), name="clean"), clean)
    minus_zero = dataclasses.replace(
        episode, actions=np.zeros((500, 2)), labels=np.full((500, 2), -0.0)
    )
    again = store.from_bytes(store.to_bytes(minus_zero), name="minus zero")
    assert np.signbit(again.labels).all()


def test_files_whose_arrays_were_packed_whole_are_still_read(tmp_path: Path) -> None:
    episode = make_episode()
    (tmp_path / "new.hdf5").write_bytes(store.to_bytes(episode))
    with (
        h5py.File(tmp_path / "new.hdf5") as new,
        h5py.File(tmp_path / "old.hdf5", "w") as old,
    ):
        for name in new:
            new.copy(name, old)
        old.attrs.update(new.attrs)
        states = old["data/demo_0/states"][()]
        del old["data/demo_0/states"]
        old["data/demo_0"].create_dataset(
            "states", data=states, chunks=states.shape, compression="gzip", shuffle=True
        )
    assert_equal(store.read(tmp_path / "old.hdf5"), episode)
