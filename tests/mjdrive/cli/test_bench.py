import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from mjdrive.benchmarks.suite import SUITE
from mjdrive.cli.main import main


def run(*words: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, ["bench", *words], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


def test_list_names_every_benchmark() -> None:
    status, shown, _ = run("--list")
    assert status == 0
    for benchmark in SUITE:
        assert benchmark.name in shown


def test_unknown_name_is_one_line_with_a_guess(tmp_path: Path) -> None:
    status, shown, complaint = run("--only", "bve", "--out", str(tmp_path / "bench.json"))
    assert (status, shown) == (2, "")
    assert re.search(r"Error: Unknown benchmark 'bve'.*Did you mean 'bev'", complaint)
    assert list(tmp_path.iterdir()) == []


def test_quick_look_at_two_rows_is_printed_and_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    status, shown, _ = run(
        *("--quick", "--only", "start", "--only", "car-racing"),
        *("--rivals", "nowhere", "--out", "bench.json"),
    )
    assert status == 0
    assert "not measured" in shown
    assert "A quick look" in " ".join(shown.split())
    written = json.loads((tmp_path / "bench.json").read_text())
    assert list(written["rows"]) == ["start", "car-racing"]
    assert [len(row["rounds"]) for row in written["rows"]["start"]] == [2, 2]
    assert written["is_quick"] is True
    assert [path.name for path in tmp_path.iterdir()] == ["bench.json"]
    status, again, _ = run("--results", "bench.json")
    assert status == 0
    assert again == shown.replace("bench.json\n", "")


def test_results_that_are_missing_are_a_mistake_of_one_line(tmp_path: Path) -> None:
    status, _, complaint = run("--results", str(tmp_path / "none.json"))
    assert status == 2
    assert "Cannot read settings from" in complaint
