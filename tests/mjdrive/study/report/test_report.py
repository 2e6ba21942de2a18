import dataclasses
import html.parser
import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from mjdrive.config import read_json, write_json
from mjdrive.datatypes import Town
from mjdrive.errors import DataError
from mjdrive.recording import mp4
from mjdrive.study.pictures import figures_paths
from mjdrive.study.pictures.figure_looks import looks
from mjdrive.study.pictures.pictures import draw_pictures
from mjdrive.study.records.reading import read_study
from mjdrive.study.records.results import STUDY, StudyRecord
from mjdrive.study.report import report
from mjdrive.study.tables.report_tables import Table, read_markdown
from mjdrive.study.tables.rows import markdown
from mjdrive.study.videos.turn_video import FRAMES_PER_SECOND
from mjdrive.study.videos.videos import video_file

VOID = {"meta", "img", "link", "br", "input", "hr"}


class Page(html.parser.HTMLParser):
    """What a page holds; asserts that every element is closed in its turn."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.links: list[str] = []
        self.anchors: list[str] = []
        self.sources: list[tuple[str, str]] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.anchors += [values["id"]] if "id" in values else []
        self.links += [values["href"]] if "href" in values else []
        self.sources += [(tag, values["src"])] if "src" in values else []
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def folder(tiny_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The JSON files of a study and one video, and nothing else."""
    copy = tmp_path_factory.mktemp("studies") / "copy"
    for path in tiny_folder.rglob("*.json"):
        if "runs" not in path.parts and "data" not in path.parts:
            target = copy / path.relative_to(tiny_folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, target)
    results = json.loads((copy / "results.json").read_text())
    results["turns"] = [
        {
            "arm": "da-ibc-sample",
            "seed": 3,
            "approach": "a",
            "exit": "b",
            "move": "left",
            "file": "t",
        }
    ]
    (copy / "results.json").write_text(json.dumps(results))
    video = copy / video_file("da-ibc-sample", 3)
    video.parent.mkdir()
    black = np.zeros((16, 16, 3), np.uint8)
    video.write_bytes(mp4.encode([black], frames_per_second=FRAMES_PER_SECOND))
    report.write_report(copy)
    return copy


@pytest.fixture(scope="module")
def text(folder: Path) -> str:
    return (folder / report.REPORT).read_text()


@pytest.fixture(scope="module")
def page(text: str) -> Page:
    return Page(text)


def test_the_page_needs_nothing_from_elsewhere(page: Page, text: str) -> None:
    assert not re.search(r"https?:|//[a-z]|url\(|@import", re.sub(r'"data:[^"]*"', '""', text))
    assert all(source.startswith("data:") for _, source in page.sources)
    assert all(link.startswith("#") for link in page.links)


def test_every_picture_and_video_is_in_the_page_as_it_is_in_the_folder(
    folder: Path, page: Page
) -> None:
    kept = [*sorted(folder.rglob("*.png")), *sorted(folder.rglob("*.mp4"))]
    assert {source for _, source in page.sources} == {report.embedded(path) for path in kept}
    assert {tag for tag, _ in page.sources} == {"img", "video"}


def test_every_entry_of_the_contents_leads_somewhere(page: Page) -> None:
    assert len(page.links) == len(set(page.links)) > 5
    assert {link[1:] for link in page.links} == set(page.anchors)


def test_the_page_says_how_it_was_made(folder: Path, text: str) -> None:
    record = read_json(StudyRecord, folder / STUDY)
    assert "mjdrive.study.study.Study, with the settings below" in text, "nothing was typed"
    for version in record.versions.values():
        assert version in text
    assert all(digest in text for digest in record.towns.values())


def test_the_command_is_told_as_it_was_typed(folder: Path, tmp_path: Path) -> None:
    copy = tmp_path / "typed"
    shutil.copytree(folder, copy)
    typed = "mjdrive study --preset quick --set long_steps=0 --jobs 2"
    record = dataclasses.replace(read_json(StudyRecord, copy / STUDY), command=typed)
    write_json(record, copy / STUDY)
    report.write_report(copy)
    page = (copy / report.REPORT).read_text()
    assert f"Made by <code>{typed}</code>" in page


def test_the_same_study_gives_the_same_page(folder: Path, text: str) -> None:
    report.write_report(folder)
    assert (folder / report.REPORT).read_text() == text


def test_a_map_of_another_town_is_not_drawn(folder: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    record = read_json(StudyRecord, copy / STUDY)
    other = dataclasses.replace(record, towns=dict.fromkeys(record.towns, "0" * 64))
    write_json(other, copy / STUDY)
    with pytest.raises(DataError, match="driven in another town02"):
        report.write_report(copy)


@pytest.mark.parametrize("seeds", [(3,), (3, 4)])
def test_long_drives_of_several_agents_say_whose_they_are(
    seeds: tuple[int, ...],
    folder: Path,
    tmp_path: Path,
    town02: Town,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    study = read_study(folder)
    settings = dataclasses.replace(study.record.settings, seeds=seeds, detail_seeds=seeds)
    record = dataclasses.replace(study.record, settings=settings)
    paths = (
        *(it for it in study.paths if it.arm == "expert"),
        *(
            dataclasses.replace(it, seed=seed)
            for it in study.paths
            if it.arm != "expert"
            for seed in seeds
        ),
    )
    drawn: set[str] = set()
    monkeypatch.setattr(
        figures_paths,
        "draw_paths",
        lambda pairs, *_, **__: drawn.update(it.label for it, _ in pairs),
    )
    shutil.copytree(folder, tmp_path / "copy")
    several = dataclasses.replace(study, record=record, paths=paths)
    list(draw_pictures(several, town02, tmp_path / "copy"))
    plain = {looks(settings)[it.arm].label for it in paths}
    agents = {looks(settings)[it.arm].label for it in paths if it.arm not in settings.references}
    named = {f"{label}, seed {seed}" for label in agents for seed in seeds}
    assert agents
    assert drawn == (plain if len(seeds) == 1 else (plain - agents) | named)


def test_a_table_is_read_as_it_was_written() -> None:
    head, body = ["", "recall"], [["DA-IBC", "0.90 [0.80, 0.95]"], ["BC", "-"]]
    assert read_markdown(markdown(head, body)) == Table(tuple(head), tuple(map(tuple, body)))


def test_a_text_without_a_table_gives_none() -> None:
    assert read_markdown("This study has no ablations.\n") is None


def test_landscapes_say_whose_draws_they_show(folder: Path, town02: Town, tmp_path: Path) -> None:
    study = read_study(folder)

    def caption(*drawn_by: str) -> str:
        records = tuple(
            dataclasses.replace(it, drawn_by=drawn_by[index % len(drawn_by)])
            for index, it in enumerate(study.landscapes)
        )
        shown = dataclasses.replace(study, landscapes=records)
        return next(
            it.caption for it in draw_pictures(shown, town02, tmp_path) if "landscapes" in it.file
        )

    own, searched = caption("own"), caption("own", "dfo")
    assert "white points are ten draws of the policy's own sampler, each made anew" in own
    assert "by the paper's search (DFO) from energies" in searched
    assert "{" not in own + searched
