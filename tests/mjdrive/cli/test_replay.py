"""`mjdrive replay` without cameras, which tests of the film pay for."""

import json
from pathlib import Path

import av
import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.datatypes import Episode
from mjdrive.episodes import store
from mjdrive.simulation import opengl


@pytest.fixture
def drive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, short_drive: Episode) -> str:
    monkeypatch.chdir(tmp_path)
    store.write(short_drive, tmp_path / "drives/x/episode.hdf5")
    return "drives/x"


def test_a_replay_draws_films_and_verifies(drive: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["replay", drive, "--no-cameras"], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    assert "the same bit by bit at all 15 steps" in " ".join(done.stdout.split())
    folder = tmp_path / "replays/x"
    names = {"trajectory.png", "actions.png", "drive.mp4", "verification.json"}
    assert {it.name for it in folder.iterdir()} == names
    assert json.loads((folder / "verification.json").read_text())["first_difference"] is None
    with av.open(str(folder / "drive.mp4")) as video:
        assert len(list(video.decode(video=0))) == 15
    again = CliRunner().invoke(main, ["replay", drive, "--no-video"])
    assert (again.exit_code, "is there already" in again.stderr) == (2, True)


def test_cameras_without_opengl_are_refused_before_anything_is_driven(
    drive: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(opengl.platform, "system", lambda: "Linux")
    monkeypatch.setattr(opengl.ctypes.util, "find_library", lambda name: None)
    done = CliRunner().invoke(main, ["replay", drive])
    assert (done.exit_code, "apt-get install" in done.stderr) == (2, True)
    assert not (tmp_path / "replays").exists()


def test_several_episodes_are_refused_with_the_name_of_one(
    drive: str, tmp_path: Path, short_drive: Episode
) -> None:
    store.write(short_drive, tmp_path / "drives/y/episode.hdf5")
    done = CliRunner().invoke(main, ["replay", "drives"])
    assert (done.exit_code, "drives/x/episode.hdf5" in done.stderr) == (2, True)
