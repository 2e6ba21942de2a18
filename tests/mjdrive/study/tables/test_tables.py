"""Tables of a study that was made up, so that every number is known."""

import dataclasses
from collections.abc import Callable

import numpy as np

from mjdrive.config import Arm, StudyConfig, Variant
from mjdrive.evaluation.choices import ChoiceStatistics
from mjdrive.study.records.measures import Curve
from mjdrive.study.records.results import StudyResults
from mjdrive.study.tables import rows, tables
from mjdrive.study.tables.ratio_table import ratio_table
from mjdrive.study.tables.summary_table import summary_table

Study = tuple[StudyConfig, StudyResults]
Cells = Callable[[str, str], dict[str, str]]


def test_the_summary_has_what_happened_to_each_agent_beside_the_expert(
    study: Study, cells: Cells, choices: ChoiceStatistics
) -> None:
    config, found = study
    first, second, plain = found.arms
    hit = dataclasses.replace(second.drives[0], collisions=1, kerb_strikes=2, off_road_s=0.1)
    choices = dataclasses.replace(choices, taken=30, recall=30 / 48)
    long = Curve((0.0, 600.0, 9_999.0, 12_000.0), (0.0, 0.5, 0.75, 1.0))
    second = dataclasses.replace(
        second, drives=(hit, second.drives[1]), choices=choices, recall=long
    )
    tenths = tuple(dataclasses.replace(first.drives[0], off_road_s=0.1) for _ in range(10))
    third = dataclasses.replace(first, seed=2, drives=tenths)
    assert sum(it.off_road_s for it in tenths) != 1.0
    shown = cells(
        summary_table(config, dataclasses.replace(found, arms=(third,))), "DA-IBC, sampled"
    )
    assert shown["off the road [s]"] == "1"
    table = summary_table(config, dataclasses.replace(found, arms=(first, second, plain)))
    mine, expert = cells(table, "DA-IBC, sampled"), cells(table, "PID expert, random walk")
    assert mine["distance / the expert's"].startswith("0.50 [")
    assert mine["red lights"] == "2 each"
    assert (mine["collisions"], mine["kerbs"], mine["against the traffic"]) == ("0, 1", "0, 2", "0 each")  # fmt: skip
    assert mine["off the road [s]"] == "0, 0.1"
    assert (mine["ways of 48"], mine["ways in 10,000 s"]) == ("24, 30", "36 (1 of 2)")
    assert mine["ways / the expert's"].startswith("1.12 [1.00, 1.25]")
    assert (expert["ways of 48"], expert["ways in 10,000 s"]) == ("24", "-")
    assert "plain" not in table, "ablations have a page of their own"


def test_the_picture_of_ablations_compares_the_same_seeds(study: Study) -> None:
    labels = {"sample": "DA-IBC", "plain": "plain head"}
    both = rows.same_seeds(study[1], labels)
    assert [(name, [it.seed for it in row.results]) for name, row in both] == [
        ("sample", [0]),
        ("plain", [0]),
    ]
    (alone,) = rows.same_seeds(study[1], {"sample": "DA-IBC"})
    assert [it.seed for it in alone[1].results] == [0, 1]


def test_every_table_of_agents_says_how_many_were_trained(study: Study, cells: Cells) -> None:
    for make in (tables.paper_table, tables.multimodality_table, ratio_table):
        assert cells(make(*study), "DA-IBC, sampled")["training seeds"] == "2"
        assert cells(make(*study), "PID expert, random walk")["training seeds"] == rows.NOTHING


def test_ablations_stand_below_the_same_seeds_of_what_they_change(
    study: Study, cells: Cells
) -> None:
    table = tables.ablation_table(*study)
    assert cells(table, "DA-IBC, sampled")["training seeds"] == "1"
    assert cells(table, "plain head")["off the road [s]"] == "3.5"
    assert list(table.splitlines())[2].startswith("| DA-IBC, sampled")
    expert = cells(table, "PID expert, random walk")
    assert list(table.splitlines())[-1].startswith("| PID expert, random walk")
    assert (expert["distance / the expert's"], expert["ways of 48"]) == ("1.00 [1.00, 1.00]", "24")
    for title in ("training seeds", "mode precision"):
        assert expert[title] == rows.NOTHING


def test_ablations_of_a_variant_that_is_one_itself_have_a_group_of_their_own(study: Study) -> None:
    config, _ = study
    brief = Variant("brief", "da-ibc", change="trained briefly")
    plain = dataclasses.replace(config.variants[1], base="brief")
    config = dataclasses.replace(
        config,
        variants=(config.variants[0], brief, plain),
        arms=(*config.arms, Arm("brief", "brief", "DA-IBC, brief")),
    )
    assert rows.ablation_labels(config) == (
        {"brief": "DA-IBC, brief", "plain": "plain head"},
        {"sample": "DA-IBC, sampled", "brief": "trained briefly"},
    )


def test_demonstrations_show_their_own_turn_balance(study: Study, cells: Cells) -> None:
    assert cells(tables.data_table(study[1]), "demonstrations") == {
        "town": "town01",
        "drives": "10",
        "samples": "21,000",
        "left / straight / right": "25 / 50 / 25 %",
        "manifest": "aaaaaaaaaaaa",
    }


def test_the_same_figures_give_the_same_cell() -> None:
    figures = np.random.default_rng(1).normal(size=(3, 5))
    assert rows.cell(figures) == rows.cell(figures)
    assert rows.cell(np.array([[2.0]])) == "2.00"
    assert rows.cell(np.array([[np.nan]])) == rows.NOTHING
