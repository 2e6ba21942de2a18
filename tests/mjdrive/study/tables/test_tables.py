"""Tables of a study that was made up, so that every number is known."""

import dataclasses

import numpy as np
import pytest

from mjdrive.config import Arm, StudyConfig, Variant
from mjdrive.evaluation.choices import ChoiceStatistics
from mjdrive.evaluation.forking import ForkOutcome
from mjdrive.study.records.measures import Curve, DriveFigures, Likelihood
from mjdrive.study.records.results import ArmResult, DataResult, StudyResults
from mjdrive.study.tables import arm_figures, rows, tables
from mjdrive.study.tables.ratio_table import ratio_table
from mjdrive.study.tables.summary_table import summary_table

CHOICES = ChoiceStatistics(
    branches=48,
    taken=24,
    recall=0.5,
    passes=40,
    entropy=0.9,
    divergence=0.2,
    divergence_floor=0.1,
    turn_shares={"left": 0.25, "straight": 0.5, "right": 0.25},
    turn_divergence=0.01,
)


def drive(distance: float = 1000.0, reds: int = 0, **changes: float) -> DriveFigures:
    figures = DriveFigures(
        seed=0,
        steps=3000,
        duration_s=300.0,
        distance_m=float(distance),
        red_lights=reds,
        lights_met=10,
        reds_met=4,
        collisions=0,
        kerb_strikes=0,
        road_departures=0,
        wrong_ways=0,
        off_road_s=0.0,
        stuck_s=0.0,
        penalty=float(0.7**reds),
        score=float(distance * 0.7**reds),
        jerk_rms=1.0,
        steering_whiteness=0.5,
        steering_unrest=2.0,
        lane_offset_rms_m=0.1,
        branches_taken={},
    )
    return dataclasses.replace(figures, **changes)  # type: ignore[arg-type]


def result(arm: str, seed: int, *drives: DriveFigures, variant: str = "da-ibc") -> ArmResult:
    return ArmResult(
        arm=arm,
        variant=variant,
        seed=seed,
        digest="",
        drives=drives,
        long_drive=None,
        choices=CHOICES,
        all_choices=CHOICES,
        recall=Curve((0.0, 600.0), (0.0, 0.5)),
        coverage=Curve((0.0, 0.4, 0.9, 2.0), (0.0, 0.4, 0.6, 0.6)),
        all_coverage=Curve((0.0, 0.4, 0.9, 2.0), (0.0, 0.4, 0.6, 0.6)),
        forks=(ForkOutcome("approach", 50, 0.9, {"left": 20, "right": 25}, 0.99),),
        likelihood=Likelihood(100, 4.5, 0.1, 3.25),
        landscape=None,
    )


@pytest.fixture
def study() -> tuple[StudyConfig, StudyResults]:
    config = StudyConfig(
        preset="made up",
        variants=(Variant("da-ibc", "da-ibc"), Variant("plain", "da-ibc", change="plain head")),
        arms=(Arm("sample", "da-ibc", "DA-IBC, sampled"), Arm("plain", "plain", "DA-IBC, plain")),
        references=("expert",),
        seeds=(0, 1),
        ablation_seeds=(0,),
    )
    expert = dataclasses.replace(
        result("expert", 0, drive(2000), drive(2000)), variant="", forks=(), likelihood=None
    )
    found = StudyResults(
        data=(DataResult("demonstrations", "town01", 10, 21_000, "a" * 64, CHOICES),),
        references=(expert,),
        arms=(
            result("sample", 0, drive(1000, 2), drive(1000)),
            result("sample", 1, drive(1000, 1), drive(1000, 1)),
            result("plain", 0, drive(500), drive(500, off_road_s=3.5), variant="plain"),
        ),
        progress=(),
        turns=(),
        landscapes=(),
        paths=(),
    )
    return config, found


def cells(table: str, label: str) -> dict[str, str]:
    """A row of a Markdown table by the titles of its columns."""
    head, _, *body = [line.strip("|\n ").split(" | ") for line in f"|x{table[1:]}".splitlines()]
    (row,) = [line for line in body if line[0].strip() == label]
    return dict(zip(head[1:], row[1:], strict=True))


def test_the_papers_table_counts_red_lights_as_the_paper_does(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    table = tables.paper_table(*study)
    mine = cells(table, "DA-IBC, sampled")
    assert mine["penalty 0.7^n per 300 s"].startswith(f"{(0.49 + 1 + 0.7 + 0.7) / 4:.2f} [")
    assert mine["score [m] per 300 s"].startswith(f"{1000 * (0.49 + 1 + 0.7 + 0.7) / 4:.0f} [")
    assert mine["score [m] per 3,000 s"].startswith("980 [980, 980]"), "2,000 m and two red lights"
    assert mine["red lights per km"].startswith("1.00 [")
    assert mine["red lights run per light met"].startswith("0.10 [")
    assert "plain" not in table, "ablations have a page of their own"


def test_the_summary_has_what_happened_to_each_agent_beside_the_expert(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    config, found = study
    first, second, plain = found.arms
    hit = dataclasses.replace(second.drives[0], collisions=1, kerb_strikes=2, off_road_s=0.1)
    choices = dataclasses.replace(CHOICES, taken=30, recall=30 / 48)
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


def test_figures_of_an_agent_are_sums_over_sums() -> None:
    mine = result("a", 0, drive(3000, 1), drive(1000, 2))
    assert arm_figures.reds_per_km(mine) == pytest.approx(0.75)
    assert arm_figures.long_score(mine) == pytest.approx(4000 * 0.7**3)
    assert arm_figures.km_to_half(mine) == 0.9
    assert arm_figures.reds_per_km(result("a", 0, drive(0))) is None


def test_ratios_are_those_to_the_expert_beside_the_bars(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    table = ratio_table(*study)
    assert cells(table, "bar")["distance / the expert's"] == "0.90"
    mine = cells(table, "DA-IBC, sampled")
    assert mine["distance / the expert's"] == "0.50 [0.50, 0.50]"
    assert mine["branch recall / the expert's"].startswith("1.00")
    assert cells(table, "PID expert, random walk")["distance / the expert's"].startswith("1.00")
    short = dataclasses.replace(study[0], steps=100)
    assert "bar" not in ratio_table(short, study[1]), "the bars are for ten drives of 300 s"


def test_recall_in_ten_thousand_seconds_is_that_of_who_drove_so_long(
    study: tuple[StudyConfig, StudyResults],
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


def test_the_picture_of_ablations_compares_the_same_seeds(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    labels = {"sample": "DA-IBC", "plain": "plain head"}
    both = rows.same_seeds(study[1], labels)
    assert [(name, [it.seed for it in row.results]) for name, row in both] == [
        ("sample", [0]),
        ("plain", [0]),
    ]
    (alone,) = rows.same_seeds(study[1], {"sample": "DA-IBC"})
    assert [it.seed for it in alone[1].results] == [0, 1]


def test_a_figure_that_some_seeds_lack_is_that_of_the_others_and_says_so(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    config, found = study
    lost = dataclasses.replace(found.arms[1], forks=(), likelihood=None)
    arms = (found.arms[0], lost, found.arms[2])
    table = tables.multimodality_table(config, dataclasses.replace(found, arms=arms))
    mine = cells(table, "DA-IBC, sampled")
    assert mine["mode precision"] == "0.90 (1 of 2)"
    assert mine["JS of turns [bit]"] == "0.010 [0.010, 0.010]"


def test_every_table_of_agents_says_how_many_were_trained(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    for make in (tables.paper_table, tables.multimodality_table, ratio_table):
        assert cells(make(*study), "DA-IBC, sampled")["training seeds"] == "2"
        assert cells(make(*study), "PID expert, random walk")["training seeds"] == rows.NOTHING


def test_exits_of_all_seeds_together_stand_beside_their_floor(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    config, found = study
    pooled = {"sample": dataclasses.replace(CHOICES, divergence=0.0312, divergence_floor=0.0124)}
    table = ratio_table(config, dataclasses.replace(found, pooled=pooled))
    mine = cells(table, "DA-IBC, sampled")
    assert mine["JS of exits, seeds pooled [bit]"] == "0.031"
    assert mine["its floor [bit]"] == "0.012"
    assert mine["JS of turns [bit]"] == "0.010 [0.010, 0.010]"


def test_ratios_are_taken_to_all_walks_of_the_expert(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    config, found = study
    first = found.references[0]
    poorer = dataclasses.replace(CHOICES, recall=CHOICES.recall / 3)
    other = dataclasses.replace(first, seed=1, drives=(drive(1000), drive(1000)), choices=poorer)
    table = ratio_table(config, dataclasses.replace(found, references=(first, other)))
    assert cells(table, "DA-IBC, sampled")["distance / the expert's"].startswith("0.67 ")
    recall = cells(table, "PID expert, random walk")["branch recall / the expert's"]
    assert recall.startswith("1.00 [0.50, 1.50]")
    assert cells(table, "DA-IBC, sampled")["branch recall / the expert's"].startswith("1.50 ")


def test_a_standstill_expert_has_no_ratio(study: tuple[StudyConfig, StudyResults]) -> None:
    config, found = study
    standing = dataclasses.replace(found.references[0], drives=(drive(0), drive(0)))
    table = ratio_table(config, dataclasses.replace(found, references=(standing,)))
    assert cells(table, "DA-IBC, sampled")["distance / the expert's"] == rows.NOTHING


def test_ablations_stand_below_the_same_seeds_of_what_they_change(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    table = tables.ablation_table(*study)
    assert cells(table, "DA-IBC, sampled")["training seeds"] == "1"
    assert cells(table, "plain head")["off the road [s]"] == "3.5"
    assert list(table.splitlines())[2].startswith("| DA-IBC, sampled")


def test_ablations_of_a_variant_that_is_one_itself_have_a_group_of_their_own(
    study: tuple[StudyConfig, StudyResults],
) -> None:
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


def test_multimodality_shows_what_was_measured_and_a_dash_elsewhere(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    table = tables.multimodality_table(*study)
    mine, expert = cells(table, "DA-IBC, sampled"), cells(table, "PID expert, random walk")
    assert mine["left / straight / right"] == "25 / 50 / 25 %"
    assert mine["mode precision"].startswith("0.90")
    assert mine["held-out log-likelihood above uniform [nats]"].startswith("4.50")
    assert expert["mode precision"] == rows.NOTHING
    assert mine["modes at junctions"] == rows.NOTHING


def test_a_long_drive_shows_in_columns_of_its_own_alone(
    study: tuple[StudyConfig, StudyResults],
) -> None:
    config, found = study
    first, *others = found.arms
    seen_more = dataclasses.replace(
        first,
        long_drive=drive(9000),
        all_choices=dataclasses.replace(CHOICES, recall=0.75, entropy=0.25),
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


def test_demonstrations_show_their_own_turn_balance(
    study: tuple[StudyConfig, StudyResults],
) -> None:
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
    assert rows.cell(None) == rows.NOTHING
