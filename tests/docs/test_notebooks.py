"""What a notebook is to be like; nbmake runs them."""

import ast
import importlib
import re
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
ABSOLUTE = re.compile(r"""["'`( ](/(?!/)\w[\w.-]*/|~/|[A-Za-z]:\\)""")
"""The beginning of a path that is on one machine only."""

PRIVATE = re.compile(r"(?:^|\.)_[a-z]")

each_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def read(path: Path) -> nbformat.NotebookNode:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    return notebook


def code(path: Path) -> list[str]:
    return [cell.source for cell in read(path).cells if cell.cell_type == "code"]


def test_there_are_five_numbered_from_one() -> None:
    assert [path.stem[:2] for path in NOTEBOOKS] == ["1_", "2_", "3_", "4_", "5_"]


@each_notebook
def test_it_begins_with_a_numbered_title_and_what_the_reader_will_see(path: Path) -> None:
    first = read(path).cells[0]
    assert first.cell_type == "markdown"
    assert first.source.startswith(f"# {path.stem[0]}. ")
    assert "You will see" in first.source


@each_notebook
def test_it_holds_no_output_and_no_trace_of_a_run(path: Path) -> None:
    for cell in read(path).cells:
        if cell.cell_type == "code":
            assert cell.outputs == []
            assert cell.execution_count is None
        assert set(cell.metadata) <= {"tags"}


@each_notebook
def test_it_names_no_place_on_one_machine(path: Path) -> None:
    for cell in read(path).cells:
        assert not ABSOLUTE.search(cell.source), cell.source


@pytest.mark.parametrize(
    ("text", "is_absolute"),
    [
        ('Path("/home/me/data")', True),
        ("open('~/data')", True),
        ("in `C:\\data`", True),
        ('Path("data/town01")', False),
        ("100 m / 3 s, [km/h], (a/b)", False),
        ("https://mujoco.org/", False),
    ],
)
def test_absolute_paths_are_told_from_others(text: str, is_absolute: bool) -> None:
    assert bool(ABSOLUTE.search(text)) == is_absolute


@each_notebook
def test_it_uses_the_public_api_alone(path: Path) -> None:
    for source in code(path):
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.ImportFrom) and node.module.startswith(("mjdrive", "models")):
                names = [node.module, *(alias.name for alias in node.names)]
                assert not any(PRIVATE.search(name) for name in names), names
            if isinstance(node, ast.Attribute):
                assert not node.attr.startswith("_"), node.attr


@each_notebook
def test_what_it_imports_exists(path: Path) -> None:
    for source in code(path):
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.ImportFrom):
                module = importlib.import_module(node.module)
                for alias in node.names:
                    if not hasattr(module, alias.name):
                        importlib.import_module(f"{node.module}.{alias.name}")


@each_notebook
def test_it_is_short_and_explains_before_it_computes(path: Path) -> None:
    cells = read(path).cells
    assert len(cells) <= 16
    assert all(len(source.splitlines()) <= 60 for source in code(path))
    texts = sum(cell.cell_type == "markdown" for cell in cells)
    assert texts >= 0.4 * len(cells)


@each_notebook
def test_one_picture_is_its_cover_and_the_page_shows_it(path: Path) -> None:
    tagged = [cell for cell in read(path).cells if "cover" in cell.metadata.get("tags", ())]
    assert len(tagged) == 1
    page = (ROOT / "docs" / "notebooks.md").read_text()
    assert f"(notebooks/{path.stem}.png)" in page
    assert f"(../notebooks/{path.name})" in page
    assert (ROOT / "docs" / "notebooks" / f"{path.stem}.png").is_file()
