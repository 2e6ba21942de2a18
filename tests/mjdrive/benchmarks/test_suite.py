import importlib
import importlib.metadata
import os
from pathlib import Path

import pytest

from mjdrive.benchmarks import machine, suite
from mjdrive.benchmarks.comparison import Comparison, Figure, NotMeasured, Plan
from mjdrive.benchmarks.suite import SUITE, Benchmark, Report, choose
from mjdrive.config import read_json, write_json
from mjdrive.errors import ConfigError, UnknownNameError, WorkerError


@pytest.fixture
def report() -> Report:
    rows = {
        "a": (Comparison("one", "work", "us", "them", (1.0, 2.0), (3.0, 4.5), bar=2.0),),
        "b": (
            Figure("two", "work", (1.0, 2.0), "ms", most=3.0),
            NotMeasured("three", "work", "It is not here.", "make it"),
        ),
    }
    return Report(machine.describe(), is_quick=True, rows=rows, seconds={"a": 1.5, "b": 0.1})


def test_every_entry_of_the_suite_exists() -> None:
    for benchmark in SUITE:
        module, _, function = benchmark.entry.partition(":")
        assert callable(getattr(importlib.import_module(f"mjdrive.benchmarks.{module}"), function))


def test_names_are_unique() -> None:
    assert len({benchmark.name for benchmark in SUITE}) == len(SUITE)


def test_all_are_chosen_if_none_is_named_and_order_is_that_of_the_table() -> None:
    assert choose(()) == SUITE
    assert [it.name for it in choose(("bev", "start"))] == ["start", "bev"]


def test_unknown_name_is_refused_with_a_guess() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'metadrive-84'"):
        choose(("metadrive84",))


def test_report_survives_json_with_every_round(report: Report, tmp_path: Path) -> None:
    write_json(report, tmp_path / "bench.json")
    assert read_json(Report, tmp_path / "bench.json") == report


def test_damaged_file_of_results_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bench.json").write_text('{"machine": 1}')
    with pytest.raises(ConfigError, match="Cannot read Report"):
        read_json(Report, tmp_path / "bench.json")


def test_run_keeps_the_rows_of_each_benchmark_and_tells_which_begins(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    row = Figure("row", "work", (1.0,), "s")
    monkeypatch.setattr(Benchmark, "measure", lambda self, plan: (row,))
    begun: list[str] = []
    found = suite.run(SUITE[:2], Plan(tmp_path), on_begin=begun.append)
    names = [benchmark.name for benchmark in SUITE[:2]]
    assert begun == names
    assert list(found.rows) == names
    assert found.all_rows == (row, row)
    assert set(found.seconds) == set(names)


def test_machine_is_described() -> None:
    described = machine.describe()
    assert described.num_cores >= 1
    assert described.memory_gb > 0.1
    assert {"mjdrive", "mujoco", "torch", "numpy"} <= set(described.versions)


def test_benchmark_that_fails_is_a_row_with_its_reason_and_costs_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    row = Figure("row", "work", (1.0,), "s")

    def rows(self: Benchmark, plan: Plan) -> tuple[Figure, ...]:
        if self is SUITE[1]:
            raise WorkerError("The process ended. Expected it to step; install it again.")
        return (row,)

    monkeypatch.setattr(Benchmark, "_rows", rows)
    kept: list[Report] = []
    found = suite.run(SUITE[:3], Plan(tmp_path), on_report=kept.append)
    lost = found.all_rows[1]
    assert found.all_rows == (row, lost, row)
    assert isinstance(lost, NotMeasured)
    assert lost.reason.startswith("The process ended")
    assert SUITE[1].name in lost.command
    assert [len(report.rows) for report in kept] == [1, 2, 3]
    assert kept[-1] == found


def test_machine_is_described_where_opencv_and_memory_are_unknown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    find = importlib.metadata.version

    def version(name: str) -> str:
        if name.startswith("opencv"):
            raise importlib.metadata.PackageNotFoundError(name)
        return find(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    monkeypatch.delattr(os, "sysconf")
    described = machine.describe()
    assert described.versions["opencv"] == "unknown"
    assert described.memory_gb == -1.0
