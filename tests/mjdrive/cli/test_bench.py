import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from mjdrive.benchmarks import machine
from mjdrive.benchmarks.comparison import Figure
from mjdrive.benchmarks.results_page import BEGIN, END
from mjdrive.benchmarks.suite import SUITE, Benchmark, Report
from mjdrive.cli.main import main
from mjdrive.config import write_json


def run(*words: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, ["bench", *words], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


def test_list_names_every_benchmark() -> None:
    status, shown, _ = run("--list")
    assert status == 0
    for benchmark in SUITE:
        assert benchmark.name in shown


def test_unknown_name_is_one_line_with_a_guess(tmp_path: Path) -> None:
    status, shown, complaint = run("--only", "bevv", "--out", str(tmp_path / "bench.json"))
    assert (status, shown) == (2, "")
    assert re.search(r"Error: Unknown benchmark 'bevv'.*Did you mean 'bev'", complaint)
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


@pytest.fixture
def no_measuring(monkeypatch: pytest.MonkeyPatch) -> None:
    def measure(self: Benchmark, plan: object) -> None:
        raise AssertionError("it was measured before its options were checked")

    monkeypatch.setattr(Benchmark, "measure", measure)


@pytest.mark.usefixtures("no_measuring")
def test_page_without_marks_is_refused_before_anything_is_measured(tmp_path: Path) -> None:
    page = tmp_path / "PAGE.md"
    for text in (None, "no marks"):
        if text is not None:
            page.write_text(text)
        status, shown, complaint = run("--quick", "--markdown", str(page))
        assert (status, shown) == (2, "")
        assert "Cannot write results into" in complaint


@pytest.mark.usefixtures("no_measuring")
def test_table_of_one_row_does_not_replace_the_whole_one(tmp_path: Path) -> None:
    page = tmp_path / "PAGE.md"
    page.write_text(f"{BEGIN}\nall rows\n{END}\n")
    status, _, complaint = run("--only", "bev", "--markdown", str(page))
    assert status == 2
    assert "would lose the rows of start, step, metadrive-84" in complaint
    part = Report(machine.describe(), is_quick=False, rows={"bev": ()}, seconds={})
    write_json(part, tmp_path / "part.json")
    status, _, complaint = run("--results", str(tmp_path / "part.json"), "--markdown", str(page))
    assert status == 2
    assert "would lose the rows" in complaint
    assert "all rows" in page.read_text()


@pytest.mark.parametrize(
    "words", [("--only", "bev"), ("--quick",), ("--rivals", ".")], ids=lambda words: words[0]
)
def test_what_has_no_effect_on_results_is_refused(words: tuple[str, ...], tmp_path: Path) -> None:
    status, _, complaint = run("--results", str(tmp_path / "bench.json"), *words)
    assert status == 2
    assert f"{words[0]} has no effect with --results" in complaint


def test_rows_of_an_interrupted_run_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def measure(self: Benchmark, plan: object) -> tuple[Figure, ...]:
        if self.name == "bev":
            raise KeyboardInterrupt
        return (Figure(self.name, "work", (1.0,), "s"),)

    monkeypatch.setattr(Benchmark, "measure", measure)
    out = tmp_path / "bench.json"
    status, _, _ = run("--out", str(out))
    assert status == 130
    assert list(json.loads(out.read_text())["rows"]) == ["start", "step"]
