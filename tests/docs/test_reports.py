"""The reports in docs/results show the tables that are made of the results beside them."""

import base64
import html.parser
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from mjdrive.config import read_json
from mjdrive.study.pictures.captions import TABLES
from mjdrive.study.records.results import RESULTS, STUDY, StudyRecord, StudyResults
from mjdrive.study.report.report import REPORT
from mjdrive.study.tables.report_tables import Table, read_markdown
from mjdrive.study.tables.tables import study_tables

ROOT = Path(__file__).resolve().parents[2]
OF_DRIVES = "da-ibc.png"
"""The one picture that `mjdrive drive` makes."""


class Page(html.parser.HTMLParser):
    """The tables of a report, and what is written below them, by the anchors of their figures."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: dict[str, list[list[str]]] = {}
        self.captions: dict[str, str] = {}
        self._figure, self._element = "", ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._element = tag
        if tag == "figure":
            self._figure = dict(attrs)["id"] or ""
        elif tag == "figcaption":
            self.captions[self._figure] = ""
        elif tag == "tr" and self._figure:
            self.tables.setdefault(self._figure, []).append([])
        elif tag in ("th", "td") and self._figure:
            self.tables[self._figure][-1].append("")

    def handle_endtag(self, tag: str) -> None:
        self._element = ""
        if tag == "figure":
            self._figure = ""

    def handle_data(self, data: str) -> None:
        if self._element in ("th", "td") and self._figure:
            self.tables[self._figure][-1][-1] += data
        elif self._element == "figcaption":
            self.captions[self._figure] += data


@pytest.fixture(params=["seeds", "methods", "ablations"])
def folder(request: pytest.FixtureRequest, load_script: Callable[[str], ModuleType]) -> Path:
    found: Path = load_script("results_tables").STUDIES[request.param]
    return found


def test_tables_of_a_report_are_those_of_its_results(folder: Path) -> None:
    config = read_json(StudyRecord, folder / STUDY).settings
    made = study_tables(config, read_json(StudyResults, folder / RESULTS))
    page = Page((folder / REPORT).read_text())
    expected = {
        f"tables-{Path(name).stem}": [list(table.head), *map(list, table.body)]
        for name, table in ((name, read_markdown(made[name])) for name in TABLES)
        if isinstance(table, Table)
    }
    assert expected
    assert {name: table for name, table in page.tables.items() if "tables-" in name} == expected
    captions = {f"tables-{Path(name).stem}": caption for name, (_, caption) in TABLES.items()}
    assert {name: page.captions[name] for name in expected} == {
        name: captions[name] for name in expected
    }


def test_a_wrong_figure_in_a_report_is_seen(folder: Path) -> None:
    text = (folder / REPORT).read_text()
    page = Page(text)
    wrong = Page(text.replace("<td>0 each</td>", "<td>1 each</td>", 1))
    differing = {name for name in page.tables if page.tables[name] != wrong.tables[name]}
    assert differing == {"tables-summary"}


def test_pictures_of_the_results_are_in_a_report(
    load_script: Callable[[str], ModuleType],
) -> None:
    folders = load_script("results_tables").STUDIES.values()
    reports = [(folder / REPORT).read_text() for folder in folders]
    pictures = sorted((ROOT / "docs/results").rglob("*.png"))
    elsewhere = {
        it.name
        for it in pictures
        if not any(base64.b64encode(it.read_bytes()).decode() in text for text in reports)
    }
    assert elsewhere == {OF_DRIVES}
