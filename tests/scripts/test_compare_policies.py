from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest
from click.testing import CliRunner

from mjdrive.errors import NameTakenError


def test_a_misspelt_policy_is_refused_before_the_first_one_drives(
    load_script: Callable[[str], ModuleType], tmp_path: Path
) -> None:
    main = load_script("compare_policies").main
    words = ["pid", "pidd", "--seeds", "1", "--steps", "1", "--out", str(tmp_path / "drives")]
    done = CliRunner().invoke(main, words, catch_exceptions=False)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("Error: Unknown")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_runs_of_one_name_are_refused_because_they_would_share_a_folder(
    load_script: Callable[[str], ModuleType], tmp_path: Path
) -> None:
    folders_of = load_script("compare_policies").folders_of
    with pytest.raises(NameTakenError, match=r"a/ibc, b/ibc would all drive into '.*drives/ibc'"):
        folders_of(("pid", "a/ibc", "b/ibc"), tmp_path / "drives")
    assert folders_of(("pid", "a/ibc"), tmp_path) == [tmp_path / "pid", tmp_path / "ibc"]
