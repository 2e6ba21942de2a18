"""The paper's table of a study that was made up."""

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from mjdrive.config import StudyConfig
from mjdrive.study.records.measures import DriveFigures
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.tables import rows, tables
from mjdrive.study.tables.paper_table import PRINTED_NOTE, long_penalty, long_score

Study = tuple[StudyConfig, StudyResults]
Cells = Callable[[str, str], dict[str, str]]
Drive = Callable[..., DriveFigures]
Result = Callable[..., ArmResult]


def test_the_papers_table_counts_red_lights_as_the_paper_does(study: Study, cells: Cells) -> None:
    table = tables.paper_table(*study)
    mine = cells(table, "DA-IBC, sampled")
    assert mine["penalty 0.7^n per 300 s"].startswith(f"{(0.49 + 1 + 0.7 + 0.7) / 4:.2f} [")
    assert mine["score [m] per 300 s"].startswith(f"{1000 * (0.49 + 1 + 0.7 + 0.7) / 4:.0f} [")
    assert mine["distance [m] per 300 s"] == "1,000 [1,000, 1,000]"
    assert mine["distance [m] per 3,000 s"] == "2,000 [2,000, 2,000]"
    assert mine["penalty 0.7^n per 3,000 s"].startswith("0.49 ["), "two red lights each"
    assert mine["10 scores [m] of 300 s added up"].startswith("1,445 ["), "1,490 m and 1,400 m"
    assert mine["score [m] per 3,000 s"].startswith("980 ["), "2,000 m and two red lights"
    assert mine["red lights per km"].startswith("1.00 [")
    assert mine["red lights run per light met"].startswith("0.10 [")
    assert "plain" not in table, "ablations have a page of their own"


def test_the_papers_own_figures_stand_where_they_can_belong(study: Study, cells: Cells) -> None:
    config, found = study
    table = tables.paper_table(config, found)
    theirs = cells(table, "DA-IBC: CARLA, as printed in the paper")
    assert {title: cell for title, cell in theirs.items() if cell != rows.NOTHING} == {
        "distance [m] per 3,000 s": "12,741 ± 209",
        "penalty 0.7^n per 300 s": "0.66 ± 0.18",
        "10 scores [m] of 300 s added up": "8,456 ± 2,322",
    }
    assert table.endswith(f"\n{PRINTED_NOTE}\n")
    other = tables.paper_table(dataclasses.replace(config, steps=100), found)
    assert "CARLA" not in other, "its episodes are of 300 s"


def test_what_the_note_says_of_the_papers_figures_is_so() -> None:
    speeds = [12_741 / seconds for seconds in (300, 3000)]
    assert speeds == pytest.approx([42, 4.2], rel=0.02)
    penalties = np.array([0.7] + [1.0] * 9)
    assert (penalties.mean(), penalties.std()) == pytest.approx((0.97, 0.09))


def test_rates_are_sums_over_sums(study: Study, cells: Cells, drive: Drive, result: Result) -> None:
    config, found = study
    arms = (
        result("sample", 0, drive(3000, 1), drive(1000, 2)),
        result("sample", 1, drive(0, 1), drive(0)),
    )
    several = dataclasses.replace(found, arms=arms)
    mine = cells(tables.paper_table(config, several), "DA-IBC, sampled")
    assert mine["red lights per km"].startswith("1.00 [0.33, "), "four in 4 km"
    assert mine["red lights run per light met"].startswith("0.10 [")
    nowhere = dataclasses.replace(found, arms=(result("sample", 0, drive(0), drive(0)),))
    mine = cells(tables.paper_table(config, nowhere), "DA-IBC, sampled")
    assert mine["red lights per km"] == rows.NOTHING


def test_scores_and_penalties_of_all_drives_count_all_red_lights_of_an_agent() -> None:
    distance, reds = (
        np.array([[3000.0, 1000.0], [500.0, 500.0]]),
        np.array([[1.0, 2.0], [0.0, 0.0]]),
    )
    assert float(long_score(distance, reds)) == pytest.approx((4000 * 0.7**3 + 1000) / 2)
    assert float(long_penalty(reds)) == pytest.approx((0.7**3 + 1) / 2)
