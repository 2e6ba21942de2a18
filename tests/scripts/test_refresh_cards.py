import json
import shutil
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main as mjdrive
from mjdrive.evaluation.drives import DESCRIPTION
from mjdrive.zoo import entries
from mjdrive.zoo.cards import read_card
from mjdrive.zoo.page import to_page

NAME = "zoo:bc-beta"
ENTRY = entries.find(NAME)


@pytest.fixture
def zoo(tmp_path: Path) -> Path:
    shutil.copytree(ENTRY, tmp_path / "zoo" / ENTRY.name)
    return tmp_path / "zoo"


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two drives of 3 s by the entry."""
    folder = tmp_path_factory.mktemp("of") / "drives"
    options = ["--town", "town02", "--steps", "30", "--episodes", "2", "--seed", "4"]
    words = ["drive", "--policy", NAME, *options, "--out", str(folder)]
    assert CliRunner().invoke(mjdrive, words, catch_exceptions=False).exit_code == 0
    return folder


@pytest.fixture
def refresh(load_script: Callable[[str], ModuleType], zoo: Path) -> Callable[..., str]:
    """Calls the script with some words, and says what it complained of."""
    script = load_script("refresh_cards")

    def call(*words: str) -> str:
        given = ["--zoo", str(zoo), *words]
        done = CliRunner().invoke(script.main, given, catch_exceptions=False)
        return done.stderr if done.exit_code else ""

    return call


def test_an_entry_gets_the_figures_of_other_drives_and_keeps_the_rest(
    refresh: Callable[..., str], zoo: Path, drives: Path
) -> None:
    before = read_card(ENTRY)
    assert not refresh("--evaluation", NAME, str(drives))
    after = read_card(zoo / ENTRY.name)
    (found,) = after.evaluations
    assert (found.steps, found.summary.episodes) == (30, 2)
    assert found.command == (
        "mjdrive drive --policy zoo:bc-beta --town town02 --steps 30 --episodes 2 --seed 4"
    )
    kept = (after.weights, after.training, after.reference)
    assert kept == (before.weights, before.training, before.reference)
    assert (zoo / ENTRY.name / entries.PAGE).read_text() == to_page(after)


def test_a_card_keeps_its_figures_where_none_are_given(
    refresh: Callable[..., str], zoo: Path
) -> None:
    assert not refresh()
    assert read_card(zoo / ENTRY.name) == read_card(ENTRY)


def test_drives_of_an_unknown_entry_are_refused(refresh: Callable[..., str], drives: Path) -> None:
    assert "Unknown shipped policy 'zoo:bc-bete'" in refresh(
        "--evaluation", "zoo:bc-bete", str(drives)
    )


def test_drives_of_another_policy_are_refused_and_no_card_is_written(
    refresh: Callable[..., str], zoo: Path, drives: Path, tmp_path: Path
) -> None:
    others = tmp_path / "others"
    shutil.copytree(drives, others)
    description = json.loads((others / DESCRIPTION).read_text())
    (others / DESCRIPTION).write_text(json.dumps({**description, "policy_digest": "ab" * 32}))
    wrong = refresh("--evaluation", NAME, str(drives), "--evaluation", NAME, str(others))
    assert "made by the weights abababababab" in wrong
    assert read_card(zoo / ENTRY.name) == read_card(ENTRY)
