"""The table beside the bars, of a study that was made up."""

import dataclasses
from collections.abc import Callable

from mjdrive.config import StudyConfig
from mjdrive.evaluation.choices import ChoiceStatistics
from mjdrive.study.records.measures import Curve, DriveFigures
from mjdrive.study.records.results import ArmResult, StudyResults
from mjdrive.study.tables import rows, tables
from mjdrive.study.tables.ratio_table import ratio_table

Study = tuple[StudyConfig, StudyResults]
Cells = Callable[[str, str], dict[str, str]]
Drive = Callable[..., DriveFigures]
Result = Callable[..., ArmResult]


def test_collisions_have_an_interval_over_drives_with_as_many_of_each_seed_or_one(
    study: Study, cells: Cells, drive: Drive, result: Result
) -> None:
    config, found = study
    first = (drive(collisions=2), *[drive()] * 9)
    alike = tuple(result("sample", seed, *first) for seed in (0, 1))
    for arms in (alike, alike[:1]):
        several = dataclasses.replace(found, arms=arms)
        for table in (tables.paper_table(config, several), ratio_table(config, several)):
            mine = cells(table, "DA-IBC, sampled")
            assert mine["collisions per 3,000 s"] == "2.00 [0.00, 6.00]"
    (alone,) = rows.same_seeds(dataclasses.replace(found, arms=alike[:1]), {"sample": "it"})
    assert rows.drive_cell(alone[1], lambda it: it.distance_m) == "1,000 [1,000, 1,000]"


def test_figures_of_all_drives_together_have_no_interval_with_one_seed(
    study: Study, cells: Cells
) -> None:
    config, found = study
    alone = dataclasses.replace(found, arms=found.arms[:1])
    mine = cells(ratio_table(config, alone), "DA-IBC, sampled")
    assert mine["branch recall / the expert's"] == "1.00"
    assert mine["JS of turns [bit]"] == "0.010"
    assert "[" in mine["infraction penalty per episode"]


def test_ratios_are_those_to_the_expert_beside_the_bars(study: Study, cells: Cells) -> None:
    table = ratio_table(*study)
    assert cells(table, "bar")["distance / the expert's"] == "0.90"
    for title in ("JS of exits, seeds pooled [bit]", "JS of turns [bit]"):
        assert [cells(table, name)[title] for name in ("bar", "goal")] == ["0.05", "0.02"]
    mine = cells(table, "DA-IBC, sampled")
    assert mine["distance / the expert's"] == "0.50 [0.50, 0.50]"
    assert mine["branch recall / the expert's"].startswith("1.00")
    assert cells(table, "PID expert, random walk")["distance / the expert's"].startswith("1.00")
    short = dataclasses.replace(study[0], steps=100)
    assert "bar" not in ratio_table(short, study[1]), "the bars are for ten drives of 300 s"


def test_recall_in_ten_thousand_seconds_is_that_of_who_drove_so_long(
    study: Study, cells: Cells, drive: Drive
) -> None:
    column = "branch recall in 10,000 s"
    config, found = study
    table = ratio_table(config, found)
    assert cells(table, "bar")[column] == "0.95"
    assert cells(table, "DA-IBC, sampled")[column] == "not driven"
    first, *others = found.arms
    curve = Curve((0.0, 3000.0, 9000.0, 10_500.0, 11_000.0), (0.0, 0.5, 0.875, 1.0, 1.0))
    long = dataclasses.replace(first, recall=curve, long_drive=drive(9000))
    table = ratio_table(config, dataclasses.replace(found, arms=(long, *others)))
    assert cells(table, "DA-IBC, sampled")[column] == "0.88 (1 of 2)"


def test_exits_of_all_seeds_together_stand_beside_their_floor(
    study: Study, cells: Cells, choices: ChoiceStatistics
) -> None:
    config, found = study
    pooled = {"sample": dataclasses.replace(choices, divergence=0.0312, divergence_floor=0.0124)}
    table = ratio_table(config, dataclasses.replace(found, pooled=pooled))
    mine = cells(table, "DA-IBC, sampled")
    assert mine["JS of exits, seeds pooled [bit]"] == "0.031"
    assert mine["its floor [bit]"] == "0.012"
    assert mine["JS of turns [bit]"] == "0.010 [0.010, 0.010]"


def test_ratios_are_taken_to_all_walks_of_the_expert(
    study: Study, cells: Cells, drive: Drive, choices: ChoiceStatistics
) -> None:
    config, found = study
    first = found.references[0]
    poorer = dataclasses.replace(choices, recall=choices.recall / 3)
    other = dataclasses.replace(first, seed=1, drives=(drive(1000), drive(1000)), choices=poorer)
    table = ratio_table(config, dataclasses.replace(found, references=(first, other)))
    assert cells(table, "DA-IBC, sampled")["distance / the expert's"].startswith("0.67 ")
    recall = cells(table, "PID expert, random walk")["branch recall / the expert's"]
    assert recall.startswith("1.00 [0.50, 1.50]")
    assert cells(table, "DA-IBC, sampled")["branch recall / the expert's"].startswith("1.50 ")


def test_a_standstill_expert_has_no_ratio(study: Study, cells: Cells, drive: Drive) -> None:
    config, found = study
    standing = dataclasses.replace(found.references[0], drives=(drive(0), drive(0)))
    table = ratio_table(config, dataclasses.replace(found, references=(standing,)))
    assert cells(table, "DA-IBC, sampled")["distance / the expert's"] == rows.NOTHING
