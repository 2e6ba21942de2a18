import os
from pathlib import Path

import pytest

from mjdrive.errors import RunError, UnknownNameError
from mjdrive.learning import runs


def make_run(folder: Path, *, age: int = 0) -> Path:
    folder.mkdir(parents=True)
    for name in runs.FILES:
        (folder / name).write_text("{}")
        os.utime(folder / name, (1000 - age, 1000 - age))
    return folder


def test_newest_is_the_run_trained_last(tmp_path: Path) -> None:
    make_run(tmp_path / "b", age=10)
    wanted = make_run(tmp_path / "a", age=5)
    (tmp_path / "c").mkdir()  # newer, but no run
    assert runs.newest(tmp_path) == wanted


def test_there_is_no_newest_run_where_nobody_trained(tmp_path: Path) -> None:
    assert runs.newest(tmp_path / "runs") is None


def test_runs_are_found_by_name_and_by_folder(tmp_path: Path) -> None:
    run = make_run(tmp_path / "da-ibc")
    assert runs.find("da-ibc", tmp_path) == run
    assert runs.find(str(run), tmp_path / "elsewhere") == run


def test_unknown_name_is_refused_with_the_nearest(tmp_path: Path) -> None:
    make_run(tmp_path / "da-ibc")
    with pytest.raises(UnknownNameError, match=r"Known: da-ibc, mpc, pid. Did you mean 'da-ibc'"):
        runs.find("da-icb", tmp_path)


def test_a_shipped_policy_is_suggested_to_who_trained_none(tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'zoo:da-ibc'"):
        runs.find("da-ibc", tmp_path, others=["zoo:da-ibc"])


def test_a_run_is_not_free_until_it_is_removed(tmp_path: Path) -> None:
    run = make_run(tmp_path / "ibc")
    (run / "notes.txt").write_text("mine")
    with pytest.raises(RunError, match=r"--resume.*--overwrite.*--out"):
        runs.require_free(run)
    runs.require_begun(run)
    runs.remove(run)
    runs.require_free(run)
    assert [path.name for path in run.iterdir()] == ["notes.txt"]
    with pytest.raises(RunError, match="no complete epoch to resume"):
        runs.require_begun(run)
