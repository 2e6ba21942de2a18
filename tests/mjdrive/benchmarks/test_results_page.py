from dataclasses import replace
from pathlib import Path

import cv2
import pytest

from mjdrive.benchmarks import machine
from mjdrive.benchmarks.comparison import Comparison, NotMeasured, Reads
from mjdrive.benchmarks.results_page import BEGIN, END, PICTURE, write_page
from mjdrive.benchmarks.suite import Report
from mjdrive.errors import DataError

CHECKOUT = Path(__file__).resolve().parents[3]


@pytest.fixture
def report() -> Report:
    rows = (
        Comparison("one | two", "work", "us", "them", (1.0, 2.0), (30.0, 40.0), bar=2.0, note="N."),
        Comparison("three", "work", "us", "them", (1.6,), (1.0,), bar=1.5, reads=Reads.COST),
        NotMeasured("four", "work", "It is not here.", "make it"),
    )
    return Report(machine.describe(), is_quick=False, rows={"a": rows}, seconds={"a": 90.0})


def test_results_replace_what_is_between_the_marks_and_nothing_else(
    report: Report, tmp_path: Path
) -> None:
    page = tmp_path / "PAGE.md"
    page.write_text(f"before\n{BEGIN}\nyesterday\n{END}\nafter\n")
    assert write_page(report, page) == [page, tmp_path / PICTURE]
    once = page.read_text()
    assert once.startswith("before\n")
    assert once.endswith("\nafter\n")
    assert "yesterday" not in once
    assert "| one \\| two | us: 1.5 s a round |" in once
    assert "| 1.6x as long (1.6 to 1.6) | at most 1.5x | **no** |" in once
    assert "| four | work |  | not measured |" in once
    assert "- one | two: N." in once
    write_page(report, page)
    assert page.read_text() == once


def test_page_tells_what_networks_found_and_what_others_took_of_the_machine(
    report: Report, tmp_path: Path
) -> None:
    page = tmp_path / "PAGE.md"
    page.write_text(f"{BEGIN}\n{END}\n")
    where = replace(report.machine, networks={"threads": "2"}, num_cores=4)
    write_page(replace(report, machine=where, others={"a": 0.25}), page)
    assert "Networks: threads 2. Other programs kept 0.25 of 4 cores busy" in page.read_text()
    write_page(replace(report, others={"a": -1.0}), page)
    assert "Other programs" not in page.read_text()


def test_picture_is_drawn_and_the_same_for_the_same_results(report: Report, tmp_path: Path) -> None:
    page = tmp_path / "PAGE.md"
    page.write_text(f"{BEGIN}\n{END}\n")
    write_page(report, page)
    picture = (tmp_path / PICTURE).read_bytes()
    assert min(cv2.imread(str(tmp_path / PICTURE)).shape[:2]) > 200
    write_page(report, page)
    assert (tmp_path / PICTURE).read_bytes() == picture


@pytest.mark.parametrize("text", [None, "nothing", f"{END} {BEGIN}"])
def test_page_without_marks_is_refused_and_stays(
    report: Report, tmp_path: Path, text: str | None
) -> None:
    page = tmp_path / "PAGE.md"
    if text is not None:
        page.write_text(text)
    with pytest.raises(DataError, match="expected a file with a line"):
        write_page(report, page)
    assert not (tmp_path / PICTURE).exists()
    assert text is None or page.read_text() == text


def test_the_page_of_the_project_has_its_marks() -> None:
    text = (CHECKOUT / "BENCHMARKS.md").read_text(encoding="utf-8")
    assert text.count(BEGIN) == text.count(END) == 1
