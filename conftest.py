"""In CI a skipped test is a failed one: what CI does not run, nobody runs."""

import os
from collections.abc import Generator

import pytest

IS_CI = os.environ.get("CI") == "true"
ALLOWED_REASONS = ("no GPU",) + (
    () if "MJDRIVE_REFERENCE_MAPS" in os.environ else ("MJDRIVE_REFERENCE_MAPS",)
)
"""Beginnings of reasons for which CI, too, may skip: it has no GPU, and CARLA's own maps only where they are given."""


NOTEBOOK_TIMEOUT = 900
"""A notebook trains, drives and draws: more than any one test, and on a busy machine more than tests may take [s]."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.path.suffix == ".ipynb":
            item.add_marker(pytest.mark.timeout(NOTEBOOK_TIMEOUT))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    _refuse_skip(report)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    _refuse_skip(report)
    return report


def _refuse_skip(report: pytest.TestReport | pytest.CollectReport) -> None:
    if not (IS_CI and report.skipped) or hasattr(report, "wasxfail"):
        return
    assert isinstance(report.longrepr, tuple)
    path, line, message = report.longrepr
    reason = message.removeprefix("Skipped: ")
    if not reason.startswith(ALLOWED_REASONS):
        report.outcome = "failed"
        report.longrepr = f"{path}:{line}: skipped in CI: {reason}"
