"""docs/results.md and README.md say of the studies what was measured."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from mjdrive.config import read_json
from mjdrive.study.records.results import RESULTS, STUDY, StudyRecord, StudyResults
from mjdrive.town import library
from mjdrive.vehicle import cars

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def script(load_script: Callable[[str], ModuleType]) -> ModuleType:
    return load_script("results_tables")


def test_tables_are_those_that_were_measured(script: ModuleType) -> None:
    pages = [page.read_text() for page in script.PAGES]
    for page in pages:
        assert script.with_tables(page) == page, "run: python scripts/results_tables.py"
    for mark in script.tables():
        assert f"<!-- {mark}: begin -->" in pages[0]
    assert "<!-- seeds, in short: begin -->" in pages[1]


def test_a_wrong_figure_in_a_page_is_seen(script: ModuleType) -> None:
    page = script.PAGES[0].read_text()
    assert "| 0 each |" in page
    assert script.with_tables(page.replace("| 0 each |", "| 1 each |")) == page


@pytest.mark.parametrize("name", ["seeds", "methods", "ablations"])
def test_studies_were_driven_in_the_towns_and_the_car_that_there_are(
    name: str, script: ModuleType
) -> None:
    record = read_json(StudyRecord, script.STUDIES[name] / STUDY)
    assert record.towns == {town: library.load(town).digest for town in record.towns}
    assert record.car == cars.load().digest
    assert record.settings.town == "town02"


@pytest.mark.parametrize(("name", "least"), [("methods", 6), ("ablations", 1)])
def test_an_agent_that_is_in_two_studies_drove_the_same_in_both(
    name: str, least: int, script: ModuleType
) -> None:
    first, second = (
        {
            (it.arm, it.seed): it
            for it in read_json(StudyResults, script.STUDIES[which] / RESULTS).arms
        }
        for which in ("seeds", name)
    )
    shared = first.keys() & second.keys()
    assert len(shared) >= least
    for key in shared:
        assert first[key].digest == second[key].digest
        assert first[key].drives == second[key].drives
        assert first[key].likelihood == second[key].likelihood


def test_draws_of_drives_have_taken_fewer_ways_than_the_agent(script: ModuleType) -> None:
    found = read_json(StudyResults, script.STUDIES["seeds"] / RESULTS)
    agents = [it for it in found.arms if it.arm.endswith("committed")]
    walks = [it for it in found.references if it.arm == "expert"]
    assert (len(agents), len(walks)) == (6, 5)
    ways = [
        name for name, lane in library.load("town02").lanes.items() if lane.junction is not None
    ]
    rng = np.random.default_rng(0)
    for result in (*agents, *walks):
        seen = np.array(
            [[it.branches_taken.get(name, 0) > 0 for name in ways] for it in result.drives]
        )
        assert seen.any(axis=0).sum() == result.choices.taken
        drawn = seen[rng.integers(10, size=(500, 10))].any(axis=1).sum(axis=1)
        assert 5 <= result.choices.taken - drawn.mean() < 7.6
        assert (drawn < result.choices.taken).mean() > 0.9
