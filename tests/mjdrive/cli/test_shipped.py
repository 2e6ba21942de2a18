"""Policies that come with mjdrive, from the command line."""

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from mjdrive.cli.driver import find_driver
from mjdrive.cli.main import main
from mjdrive.episodes import store
from mjdrive.errors import UnknownNameError
from mjdrive.zoo import entries
from models import checkpoint


def called(*words: str) -> Result:
    return CliRunner().invoke(main, ["drive", *words], catch_exceptions=False)


def test_a_shipped_policy_drives_where_nobody_trained_and_a_line_says_so(tmp_path: Path) -> None:
    notes: list[str] = []
    driver = find_driver(None, tmp_path / "runs", on_note=notes.append)
    weights = entries.find("zoo:da-ibc") / checkpoint.MODEL
    assert driver.name == "zoo:da-ibc"
    assert driver.digest == store.digest(weights.read_bytes())
    assert len(notes) == 1
    assert "so zoo:da-ibc drives" in notes[0]


def test_who_names_a_shipped_policy_is_told_nothing(tmp_path: Path) -> None:
    notes: list[str] = []
    assert find_driver("zoo:da-ibc", tmp_path, on_note=notes.append).pilot is not None
    assert notes == []


def test_a_misspelt_one_is_refused_in_a_line_with_the_nearest() -> None:
    refused = called("--policy", "zoo:da-icb", "--town", "town02")
    assert refused.exit_code == 2
    assert "Did you mean 'zoo:da-ibc'?" in refused.stderr
    assert refused.stderr.count("\n") == 1


def test_its_bare_name_is_answered_with_its_full_one(tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'zoo:da-ibc'"):
        find_driver("da-ibc", tmp_path)


def test_the_list_names_all_of_them_and_needs_no_town() -> None:
    shown = called("--policy", "zoo:")
    assert shown.exit_code == 0
    assert all(name in shown.stdout for name in entries.full_names())
