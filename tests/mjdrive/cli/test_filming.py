"""`mjdrive drive --video`."""

from pathlib import Path

import av
import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.simulation import opengl

WORDS = ("drive", "--town", "town02", "--steps", "2", "--out", "one", "--video")


def test_the_video_of_a_trained_policy_is_one_that_browsers_play(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(main, [*WORDS, "--policy", "zoo:da-ibc"], catch_exceptions=False)
    assert (done.exit_code, "one/drive.mp4" in done.stdout) == (0, True)
    with av.open(str(tmp_path / "one/drive.mp4")) as video:
        stream = video.streams.video[0]
        assert (stream.codec_context.name, stream.pix_fmt) == ("h264", "yuv420p")
        assert (stream.width, stream.height) == (1200, 726)
        assert len(list(video.decode(stream))) == 2


def test_without_opengl_nothing_is_driven_and_a_package_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(opengl.platform, "system", lambda: "Linux")
    monkeypatch.setattr(opengl.ctypes.util, "find_library", lambda name: None)
    done = CliRunner().invoke(main, [*WORDS, "--policy", "pid"])
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1)
    assert "apt-get install libegl1" in done.stderr
    assert not list(tmp_path.iterdir())


def test_many_drives_are_not_filmed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(main, [*WORDS, "--policy", "pid", "--episodes", "2"])
    assert (done.exit_code, "without --episodes" in done.stderr) == (2, True)
    assert not list(tmp_path.iterdir())
