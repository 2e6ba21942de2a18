"""Files in carla-bc's layout: taken over where somebody has added poses and times, else refused with what is missing."""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.datatypes import Episode
from mjdrive.episodes import dataset
from mjdrive.errors import DataError
from mjdrive.exchange import from_carla_bc, importing
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import town_of
from mjdrive.vehicle.parameters import VehicleParameters

OWN = ("done", "actions", "state")
"""Columns that carla-bc has by itself."""


def pandas(column: Sequence[Any]) -> dict[str, Any]:
    """A column as pandas writes it, in another order."""
    return {str(step): column[step] for step in reversed(range(len(column)))}


def in_carla(episode: Episode) -> dict[str, Any]:
    """A drive of ours as carla-bc would have seen it in CARLA, with the columns that we need."""
    parameters = VehicleParameters.default()
    x, y, yaw, *_ = episode.vehicle.T
    ahead = parameters.length / 2 - parameters.rear_overhang
    acceleration, steering = episode.labels.T
    steps = len(episode.time)
    values = {
        "done": [False] * steps,
        "actions": np.column_stack([acceleration, -steering]).tolist(),
        "state": [[0.0] * 6] * steps,
        "town": [episode.town.capitalize()] * steps,
        "x": (x + ahead * np.cos(yaw)).tolist(),
        "y": (-(y + ahead * np.sin(yaw))).tolist(),
        "yaw": np.degrees(-yaw).tolist(),
        "time": (episode.time + episode.light_phase).tolist(),
    }
    return {name: pandas(column) for name, column in values.items()}


def written(folder: Path, columns: Any, place: str = "route_00/ep_00") -> Path:
    (folder / place).mkdir(parents=True)
    (folder / place / from_carla_bc.FILE).write_text(json.dumps(columns))
    return folder


def test_with_poses_and_times_the_drive_and_its_views_come_back(
    short_drive: Episode, tmp_path: Path
) -> None:
    ((name, episode, _),) = from_carla_bc.read(written(tmp_path, in_carla(short_drive)))
    assert (name, episode.town, episode.policy) == ("route_00_ep_00", "town02", "carla-bc")
    np.testing.assert_allclose(episode.actions, short_drive.labels)
    np.testing.assert_allclose(
        episode.time + episode.light_phase, short_drive.time + short_drive.light_phase
    )
    np.testing.assert_allclose(episode.vehicle[:, :3], short_drive.vehicle[:, :3], atol=1e-9)
    np.testing.assert_allclose(episode.vehicle[1:-1, 3], short_drive.vehicle[1:-1, 3], atol=0.1)
    views = ViewMaker(town_of(episode))
    for step in (0, 7, 14):
        np.testing.assert_array_equal(views.bev(episode, step), views.bev(short_drive, step))


def test_what_turns_left_here_turned_left_there(tmp_path: Path) -> None:
    steps, rate = 20, 0.3  # a left turn [rad/s] across the ends of the circle
    time, yaw = 0.1 * np.arange(steps), 3.0 + 0.1 * rate * np.arange(steps)
    columns = {
        "actions": [[0.2, -0.5, 0.7]] * steps,
        "speed": [4.0] * steps,
        "town": ["Town02"] * steps,
        "x": [50.0] * steps,
        "y": [-80.0] * steps,
        "yaw": np.degrees(-yaw).tolist(),
        "time": (7.0 + time).tolist(),
    }
    columns = {name: pandas(column) for name, column in columns.items()}
    (recording,) = from_carla_bc.read(written(tmp_path, columns))
    _, y, found, speed, yaw_rate, steering_angle = recording.episode.vehicle.T
    np.testing.assert_allclose(np.cos(found - yaw), 1.0)
    assert np.all((-math.pi < found) & (found <= math.pi))
    assert found.min() < 0 < found.max()
    np.testing.assert_allclose(yaw_rate, rate)
    np.testing.assert_allclose(recording.episode.actions, [[-0.5, 0.5]] * steps)
    assert np.all(steering_angle > 0)
    assert np.all(speed == 4.0)
    assert np.all(np.abs(y - 80.0) < 2.0)
    assert recording.episode.light_phase == 7.0


def test_what_carla_bc_has_by_itself_is_refused_with_what_it_lacks(
    short_drive: Episode, tmp_path: Path
) -> None:
    columns = in_carla(short_drive)
    own = written(tmp_path / "own", {name: columns[name] for name in OWN})
    with pytest.raises(
        DataError, match=r"1 episodes .* done, actions, state, .* lack town, position x, position y"
    ):
        from_carla_bc.read(own)
    for name, words in from_carla_bc.NEEDED.items():
        rest = {it: column for it, column in columns.items() if it != name}
        with pytest.raises(DataError, match=f"They lack {words}, so"):
            from_carla_bc.read(written(tmp_path / name, rest))


def test_one_episode_that_lacks_something_refuses_all(short_drive: Episode, tmp_path: Path) -> None:
    columns = in_carla(short_drive)
    folder = written(tmp_path, columns, "route_0/ep_0")
    written(tmp_path, {name: columns[name] for name in OWN}, "route_1/ep_0")
    with pytest.raises(DataError, match=r"holds 2 episodes .* lack town"):
        from_carla_bc.read(folder)


DAMAGE = {
    "steps": ("x", {"0": 1.0}, "as many in each column"),
    "names": ("time", {"first": 1.0}, "invalid literal"),
    "row": ("x", [1.0, 2.0], "no whole episode"),
    "towns": ("town", pandas(["Town01", *["Town02"] * 14]), "expected one town"),
    "time": ("time", pandas([0.0] * 15), "times do not grow"),
    "nan": ("yaw", pandas([math.nan] * 15), "no finite numbers"),
    "vectors": ("speed", pandas([[4.0, 0.0]] * 15), "one number a step"),
    "words": ("x", pandas(["far"] * 15), "could not convert"),
    "pedals": ("actions", pandas([[0.0, 3.0]] * 15), r"in \[-1, 1\], found \(15, 2\) up to 3"),
    "shape": ("actions", pandas([[0.0]] * 15), r"found \(15, 1\)"),
}


@pytest.mark.parametrize(("name", "column", "words"), DAMAGE.values(), ids=DAMAGE.keys())
def test_damaged_columns_are_refused(
    name: str, column: Any, words: str, short_drive: Episode, tmp_path: Path
) -> None:
    folder = written(tmp_path, in_carla(short_drive) | {name: column})
    with pytest.raises(DataError, match=words):
        from_carla_bc.read(folder)


def test_what_is_no_data_set_of_carla_bc_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="holds no demonstrations of carla-bc"):
        from_carla_bc.read(tmp_path)
    with pytest.raises(DataError, match="holds a list; expected columns by name"):
        from_carla_bc.read(written(tmp_path / "list", []))
    (tmp_path / "list/route_00/ep_00/episode.json").write_text("{")
    with pytest.raises(DataError, match="is no JSON file"):
        from_carla_bc.read(tmp_path / "list")


def test_the_command_makes_a_data_set_to_learn_from(
    short_drive: Episode, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    written(tmp_path / "theirs", in_carla(short_drive))
    words = ["import", "--from", "carla-bc", "theirs"]
    done = CliRunner().invoke(main, words, catch_exceptions=False)
    assert (done.exit_code, "mjdrive train da-ibc --data data/theirs" in done.stdout) == (0, True)
    manifest, (episode,) = dataset.read_dataset(tmp_path / "data/theirs")
    assert (manifest.town, manifest.episodes[0].steps) == ("town02", 15)
    assert episode.metadata[importing.IMPORTED] == "carla-bc theirs"
