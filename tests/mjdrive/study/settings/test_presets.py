"""Named studies: what each of them compares, and how it acts."""

import dataclasses

import pytest

from mjdrive.errors import UnknownNameError
from mjdrive.study.settings import presets
from mjdrive.study.settings.agents import (
    ablations,
    agents,
    arm_agents,
    arm_settings,
    learner_config,
    main_arm,
    require_buildable,
)
from mjdrive.study.settings.overrides import chosen
from models.config import METHODS


@pytest.mark.parametrize("name", presets.PRESETS)
def test_every_setting_of_a_preset_has_a_meaning(name: str) -> None:
    require_buildable(chosen(name))


@pytest.mark.parametrize("name", ["standard", "paper"])
def test_mode_and_sample_of_bc_and_of_the_energy_are_compared(name: str) -> None:
    ways = {(arm.variant, setting) for arm in chosen(name).arms for setting in arm.acting}
    kind = "grid" if name == "standard" else "dfo"
    assert {("bc-beta", "beta.inference=mode"), ("bc-beta", "beta.inference=sample")} <= ways
    choices = {("da-ibc", f"sampler.{kind}.choice={choice}") for choice in ("sample", "argmin")}
    assert choices <= ways


def test_the_standard_study_compares_all_methods_and_two_of_them_with_three_agents() -> None:
    trained = [it for it in agents(chosen("standard")) if not it.variant.change]
    thorough = ("bc-beta", "da-ibc")
    assert [it.name for it in trained] == [
        f"{name}-{seed}" for name in METHODS for seed in ((0, 1, 2) if name in thorough else (0,))
    ]


def test_all_methods_of_the_standard_study_learn_equally_long_from_as_much() -> None:
    study = chosen("standard")
    optimisers = [learner_config(it).optimiser for it in study.variants if not it.change]
    assert {(it.epochs, it.epochs_per_pass, it.batch_size) for it in optimisers} == {(4, 4, 64)}
    learnt = {it.name: it.random_walk_km for it in study.demonstrations}
    assert learnt == {"demonstrations": 400.0, "undisturbed": 400.0, "routes": 0.0}


def test_the_paper_study_has_its_settings() -> None:
    study = chosen("paper")
    assert (study.episodes, study.steps, study.progress_every) == (10, 3000, 10)
    assert (study.progress_episodes, study.progress_steps) == (10, 3000)
    assert [it.preset for it in study.demonstrations] == ["paper"]
    assert {it.optimiser.epochs for it in map(learner_config, study.variants)} == {400}
    assert [it.name for it in agents(study)] == [
        f"{name}-{seed}" for name in ("bc-beta", "ibc", "da-ibc") for seed in range(3)
    ]
    assert [it.name for it in study.arms] == [
        "bc-beta-mode",
        "bc-beta-sample",
        "ibc-dfo",
        "da-ibc-dfo",
        "da-ibc-dfo-argmin",
    ]


@pytest.mark.parametrize("methods", [None, ["ibc"]])
def test_energies_of_the_paper_study_act_by_the_papers_search_alone(
    methods: list[str] | None,
) -> None:
    study = chosen("paper", methods=methods)
    variants = {it.name: learner_config(it) for it in study.variants}
    energies = [it for it in study.arms if it.variant != "bc-beta"]
    assert energies
    for arm in energies:
        settings = arm_settings(study, arm)
        own = variants[arm.variant].sampler
        is_main = arm is main_arm(study, arm.variant)
        assert (settings.sampler == own) == is_main, "the first way to act is that of its preset"
        assert settings.sampler.dfo == dataclasses.replace(
            own.dfo, choice="sample" if is_main else "argmin"
        )
        assert (settings.sampler.kind, settings.sampler.dfo.temper) == ("dfo", False)
        assert settings.commitment.hold == 0


def test_a_name_is_one_way_to_act_in_all_studies() -> None:
    """Of each method alone as well, as a preset then takes ways to act from elsewhere."""
    ways: dict[str, set[tuple[str, ...]]] = {}
    for preset in presets.PRESETS:
        for methods in (None, *([method] for method in METHODS)):
            for arm in chosen(preset, methods=methods).arms:
                ways.setdefault(arm.name, set()).add((arm.variant, arm.label, *sorted(arm.acting)))
    assert {name: len(it) for name, it in ways.items() if len(it) > 1} == {}


@pytest.mark.parametrize("name", ["papers-negatives", "kde-loss", "previous-action", "plain-head"])
def test_an_ablation_differs_from_da_ibc_by_what_it_says(name: str) -> None:
    study = chosen("standard")
    variants = {it.name: it for it in study.variants}
    assert variants[f"da-ibc-{name}"].change
    assert learner_config(variants[f"da-ibc-{name}"]) != learner_config(variants["da-ibc"])


def test_undisturbed_demonstrations_are_a_data_set_of_their_own() -> None:
    study = chosen("standard")
    others = {it.name for it in study.variants if it.demonstrations == "undisturbed"}
    assert others == {"da-ibc-undisturbed", "da-ibc-perturbed", "da-ibc-papers"}
    assert {it.demonstrations for it in study.variants} == {
        "demonstrations",
        "undisturbed",
        "routes",
    }
    assert [it.name for it in chosen("standard", ablations=False).demonstrations] == [
        "demonstrations"
    ]


def test_ablations_of_acting_need_no_training_and_fewer_seeds() -> None:
    study = chosen("standard")
    seeds = [it.agent.seed for it in arm_agents(study) if it.arm.name == "da-ibc-cold"]
    assert seeds == [0]
    assert len([it for it in arm_agents(study) if it.arm.name == "da-ibc-sample"]) == 3


def test_da_ibc_that_evens_out_rare_actions_is_trained_as_the_methods_are_if_asked_for() -> None:
    arms = ["da-ibc-committed", "da-ibc-kde-committed", "da-ibc-kde-sample", "da-ibc-kde-argmin"]
    assert not any("kde-committed" in it.name for it in chosen("standard").arms)
    study = chosen("standard", arms=arms)
    assert [it.name for it in study.arms] == arms
    assert [it.name for it in agents(study)] == [
        f"{name}-{seed}" for name in ("da-ibc", "da-ibc-kde") for seed in range(3)
    ]
    assert len(arm_agents(study)) == 12
    (group,) = ablations(study)
    assert [it.name for it in group] == arms
    assert len({it.change or "pairs drawn by 1/KDE, for the whole pass" for it in group[1:]}) == 3
    for given in (
        {"preset": "quick"},
        {"preset": "standard", "ablations": False},
        {"preset": "standard", "methods": ["bc-beta"]},
    ):
        with pytest.raises(UnknownNameError, match=r"arm of this study 'da-ibc-kde-sample'"):
            chosen(**given, arms=["da-ibc-kde-sample"])  # type: ignore[arg-type]


def test_drawing_anew_is_a_row_among_the_ablations_and_stays_an_arm_of_the_study() -> None:
    study = chosen("standard")
    (arm,) = [it for it in study.arms if it.name == "da-ibc-sample"]
    assert not arm.change
    rows = {
        it.name: it.change
        for base, *changed in ablations(study)
        if base.name == "da-ibc-committed"
        for it in changed
    }
    assert rows["da-ibc-sample"] == "no commitment: each action is drawn anew"
    assert "da-ibc-argmin" not in rows
    alone = chosen("standard", arms=["da-ibc-sample", "da-ibc-argmin"])
    assert ablations(alone) == (), "it cannot be a change of itself"
    assert ablations(chosen("standard", ablations=False)) == ()


def test_each_variant_has_one_main_arm() -> None:
    main = [it.arm for it in arm_agents(chosen("standard", seeds=[0])) if it.is_main]
    assert len(main) == len({arm.variant for arm in main}) == len(chosen("standard").variants)


def test_methods_that_a_preset_lacks_can_be_asked_for() -> None:
    assert [it.name for it in chosen("quick", methods=["flow"]).arms] == ["flow-committed"]
    assert [it.name for it in chosen("paper", methods=["diffusion"]).arms] == [
        "diffusion-committed",
        "diffusion-sample",
    ]
