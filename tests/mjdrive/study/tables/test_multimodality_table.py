"""The table of multimodality, of a study that was made up."""

import dataclasses
from collections.abc import Callable

from mjdrive.config import StudyConfig
from mjdrive.evaluation.choices import ChoiceStatistics
from mjdrive.study.records.measures import Curve, DriveFigures, LandscapeFigures
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.tables import arm_figures, rows, tables

Study = tuple[StudyConfig, StudyResults]
Cells = Callable[[str, str], dict[str, str]]
Drive = Callable[..., DriveFigures]
Result = Callable[..., ArmResult]


def test_half_of_the_lanes_are_seen_where_the_curve_comes_to_a_half(
    drive: Drive, result: Result
) -> None:
    assert arm_figures.km_to_half(result("a", 0, drive())) == 0.9


def test_a_figure_that_some_seeds_lack_is_that_of_the_others_and_says_so(
    study: Study, cells: Cells
) -> None:
    config, found = study
    lost = dataclasses.replace(found.arms[1], forks=(), likelihood=None)
    arms = (found.arms[0], lost, found.arms[2])
    table = tables.multimodality_table(config, dataclasses.replace(found, arms=arms))
    mine = cells(table, "DA-IBC, sampled")
    assert mine["mode precision"] == "0.90 (1 of 2)"
    assert mine["JS of turns [bit]"] == "0.010 [0.010, 0.010]"


def test_multimodality_shows_what_was_measured_and_a_dash_elsewhere(
    study: Study, cells: Cells
) -> None:
    table = tables.multimodality_table(*study)
    mine, expert = cells(table, "DA-IBC, sampled"), cells(table, "PID expert, random walk")
    assert mine["left / straight / right"] == "25 / 50 / 25 %"
    assert mine["mode precision"].startswith("0.90")
    assert mine["held-out log-likelihood above uniform [nats]"].startswith("4.50")
    assert expert["mode precision"] == rows.NOTHING
    assert mine["modes at junctions"] == rows.NOTHING


def test_multimodality_shows_how_many_modes_there_are_and_what_the_heaviest_weighs(
    study: Study, cells: Cells
) -> None:
    config, found = study
    seen = LandscapeFigures(frames=124, modes=1.25, multimodal=0.25, heaviest=0.875, entropy=3.5)
    arms = tuple(dataclasses.replace(it, landscape=seen) for it in found.arms[:1])
    table = tables.multimodality_table(config, dataclasses.replace(found, arms=arms))
    mine, expert = cells(table, "DA-IBC, sampled"), cells(table, "PID expert, random walk")
    assert mine["modes at junctions"] == "1.25"
    assert mine["share of moments with several"] == "0.250"
    assert mine["mass of the heaviest mode"] == "0.875"
    assert expert["mass of the heaviest mode"] == rows.NOTHING


def test_a_long_drive_shows_in_columns_of_its_own_alone(
    study: Study, cells: Cells, drive: Drive, choices: ChoiceStatistics
) -> None:
    config, found = study
    first, *others = found.arms
    seen_more = dataclasses.replace(
        first,
        long_drive=drive(9000),
        all_choices=dataclasses.replace(choices, recall=0.75, entropy=0.25),
        all_coverage=Curve((0.0, 0.3, 9.0), (0.0, 0.7, 0.8)),
    )
    short = tables.multimodality_table(config, found)
    long = tables.multimodality_table(config, dataclasses.replace(found, arms=(seen_more, *others)))
    before, after = (cells(table, "DA-IBC, sampled") for table in (short, long))
    changed = {name: cell for name, cell in after.items() if before[name] != cell}
    assert {name.partition(" in ")[0]: cell for name, cell in changed.items()} == {
        "branch recall": "0.75 (1 of 2)",
        "directed lanes visited": "0.80 (1 of 2)",
        "km to half of them": "0.30 (1 of 2)",
        "branch entropy": "0.25 (1 of 2)",
    }
    assert all("long drive included" in name for name in changed)
