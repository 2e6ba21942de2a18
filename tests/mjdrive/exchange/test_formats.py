"""What all exports have in common: whole or not at all, and over nothing that is there."""

import importlib.util
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.datatypes import Episode
from mjdrive.episodes import store
from mjdrive.errors import DataError, MissingPackageError, UnknownNameError
from mjdrive.exchange import formats
from mjdrive.exchange.sources import Recording

HTML, MINARI = formats.FORMATS["html"], formats.FORMATS["minari"]


def test_an_unknown_format_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'minari'"):
        formats.known("minary")


def test_a_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MissingPackageError, match=r"'rerun-sdk' is not installed.*\[export\]"):
        formats.known("rerun")
    assert formats.known("html") == HTML  # needs none


def test_nothing_is_overwritten_unasked_and_only_exports_are(
    tmp_path: Path, recordings: list[Recording]
) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "letter.txt").write_text("dear")
    with pytest.raises(DataError, match="is there already"):
        formats.export(recordings, MINARI, mine)
    with pytest.raises(DataError, match="no export made"):
        formats.export(recordings, MINARI, mine, overwrite=True)
    assert [it.name for it in mine.iterdir()] == ["letter.txt"]
    made = tmp_path / "made"
    formats.export(recordings, MINARI, made)
    with pytest.raises(DataError, match="--overwrite"):
        formats.export(recordings, MINARI, made)
    formats.export(recordings[:1], MINARI, made, overwrite=True)
    assert len(json.loads((made / formats.MARK).read_text())["episodes"]) == 1
    assert sorted(it.name for it in tmp_path.iterdir()) == ["made", "mine"]


def test_several_drives_do_not_go_into_one_file(
    tmp_path: Path, recordings: list[Recording]
) -> None:
    with pytest.raises(DataError, match="2 drives do not fit into the one file"):
        formats.export(recordings, HTML, tmp_path / "page.html")
    assert not list(tmp_path.iterdir())


def test_an_export_that_fails_leaves_nothing(
    tmp_path: Path, recordings: list[Recording], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise DataError("no")

    monkeypatch.setattr("mjdrive.exchange.minari.rewards_of", fail)
    with pytest.raises(DataError, match="no"):
        formats.export(recordings, MINARI, tmp_path / "out")
    assert not list(tmp_path.iterdir())


def test_steps_of_all_drives_are_counted_through(
    tmp_path: Path, recordings: list[Recording]
) -> None:
    done: list[int] = []
    formats.export(recordings, HTML, tmp_path / "pages", on_step=done.append)
    assert done == list(range(1, 1 + sum(len(it.episode.time) for it in recordings)))


def test_the_command_exports_a_drive_and_says_where(
    tmp_path: Path, short_drive: Episode, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    store.write(short_drive, tmp_path / "drives/x/episode.hdf5")
    done = CliRunner().invoke(main, ["export", "drives/x", "--to", "html"], catch_exceptions=False)
    assert (done.exit_code, "exports/x-html" in done.stdout) == (0, True)
    assert (tmp_path / "exports/x-html/x.html").is_file()
    again = CliRunner().invoke(main, ["export", "drives/x", "--to", "html"])
    assert (again.exit_code, again.stderr.count("\n")) == (2, 1)
