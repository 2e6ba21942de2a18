"""Documentation that does not run is a rumour."""

import re
import shlex
from pathlib import Path

import click
import mktestdocs
import nbformat
import pytest

from mjdrive.cli.main import main

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    ROOT / name
    for name in (
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "docs/towns.md",
        "docs/car.md",
        "docs/cars.md",
        "docs/experts.md",
        "docs/recordings.md",
        "docs/results.md",
        "docs/study.md",
        "docs/zoo.md",
        "docs/notebooks.md",
    )
]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


def text_of(page: Path) -> str:
    """The text of a page, or of a notebook without its code."""
    if page.suffix == ".md":
        return page.read_text()
    cells = nbformat.read(page, as_version=4).cells
    return "\n\n".join(cell.source for cell in cells if cell.cell_type == "markdown")


def blocks(page: Path) -> list[str]:
    """Every line of the shell blocks of a page."""
    found = re.findall(r"^```bash\n(.*?)^```", text_of(page), flags=re.MULTILINE | re.DOTALL)
    return [line for block in found for line in block.splitlines() if line]


def mentions(page: Path) -> list[str]:
    """Every call of mjdrive or make within a line of text."""
    found = re.findall(r"`([^`\n]+)`", text_of(page))
    return [line for line in found if re.match(r"(mjdrive|make) [a-z]", line)]


def find_command(words: list[str]) -> tuple[click.Command, list[str]]:
    """The command, or the command of a group, that words call, and what is left of them."""
    command: click.Command = main
    while isinstance(command, click.Group) and words:
        command, words = command.commands[words[0]], words[1:]
    return command, words


def test_the_pages_show_the_three_lines() -> None:
    shown = blocks(ROOT / "README.md")
    for line in ("collect --town town01", "train da-ibc", "drive --town town02 --steps 3000"):
        assert f"mjdrive {line}" in shown


@pytest.mark.parametrize("page", PAGES + NOTEBOOKS, ids=lambda page: page.name)
def test_commands_and_their_options_exist(page: Path) -> None:
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), flags=re.MULTILINE))
    for line in blocks(page) + mentions(page):
        program, *words = shlex.split(line)
        if program == "make":
            assert set(words) <= targets, line
        elif program == "mjdrive" and not words[0].startswith("--"):
            command, rest = find_command(words)
            known = {it for param in command.params for it in (*param.opts, *param.secondary_opts)}
            assert {word for word in rest if word.startswith("-")} <= known | {"--help"}, line


@pytest.mark.parametrize("page", PAGES + NOTEBOOKS, ids=lambda page: page.name)
def test_lines_in_blocks_can_be_run(page: Path) -> None:
    for line in blocks(page):
        program, *words = shlex.split(line)
        assert program in {"mjdrive", "make"}, line
        if program == "mjdrive":
            command, rest = find_command(words)
            command.parse_args(click.Context(command), rest)  # raises on what it cannot read


@pytest.mark.parametrize("page", PAGES + NOTEBOOKS, ids=lambda page: page.name)
def test_links_and_paths_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#:]+)\)", text_of(page)):
        assert (page.parent / target).exists(), target


def test_rooms_and_files_of_the_architecture_are_those_there_are() -> None:
    drawn = (ROOT / "ARCHITECTURE.md").read_text().partition("## Folders")[2].partition("##")[0]
    there = {path.name for folder in ("mjdrive", "models") for path in (ROOT / folder).rglob("*.*")}
    assert set(re.findall(r"\b\w+\.py\b", drawn)) <= there
    rooms = {path.parent.name for path in (ROOT / "mjdrive").glob("*/__init__.py")}
    assert rooms == set(re.findall(r"^ {6}(\w+)/", drawn, flags=re.MULTILINE)) - {"samplers"}
    inner = {path.parent.name for path in (ROOT / "mjdrive").glob("*/*/__init__.py")}
    assert inner == set(re.findall(r"^ {8}(\w+)/", drawn, flags=re.MULTILINE))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_python_blocks_run(page: Path) -> None:
    mktestdocs.check_md_file(page, memory=True)
