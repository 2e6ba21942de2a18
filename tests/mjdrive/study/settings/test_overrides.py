"""What the command line changes of a study, and the presets that it begins with."""

import pytest

from mjdrive.errors import ConfigError, UnknownNameError
from mjdrive.study.settings import presets
from mjdrive.study.settings.agents import agents, arm_agents, learner_config, require_buildable
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


def test_seeds_that_are_asked_for_are_those_of_all_methods() -> None:
    for study in (
        chosen("standard", seeds=[3, 4]),
        chosen("standard", assignments=["seeds=[3,4]"]),
    ):
        trained = [it.name for it in agents(study) if not it.variant.change]
        assert trained == [f"{name}-{seed}" for name in METHODS for seed in (3, 4)]


def test_methods_that_are_asked_for_have_three_agents_each() -> None:
    trained = agents(chosen("standard", methods=["ibc", "flow"]))
    assert [it.name for it in trained] == [
        f"{it}-{seed}" for it in ("ibc", "flow") for seed in range(3)
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
    assert len(agents(study)) == 6


@pytest.mark.parametrize("name", ["papers-negatives", "kde-loss", "previous-action", "plain-head"])
def test_an_ablation_differs_from_da_ibc_by_what_it_says(name: str) -> None:
    study = chosen("standard")
    variants = {it.name: it for it in study.variants}
    assert variants[f"da-ibc-{name}"].change
    assert learner_config(variants[f"da-ibc-{name}"]) != learner_config(variants["da-ibc"])


def test_undisturbed_demonstrations_are_a_data_set_of_their_own() -> None:
    study = chosen("standard")
    others = {it.name for it in study.variants if it.demonstrations == "undisturbed"}
    assert others == {"da-ibc-undisturbed", "da-ibc-papers"}
    assert {it.demonstrations for it in study.variants} == {
        "demonstrations",
        "undisturbed",
        "routes",
    }
    assert [it.name for it in chosen("standard", ablations=False).demonstrations] == [
        "demonstrations"
    ]


def test_what_acts_in_none_of_the_ways_that_are_kept_is_not_trained() -> None:
    study = chosen("standard", arms=["da-ibc-committed", "bc-beta-sample"])
    assert [it.name for it in study.arms] == ["bc-beta-sample", "da-ibc-committed"]
    assert [it.name for it in study.variants] == ["bc-beta", "da-ibc"]
    assert [it.name for it in study.demonstrations] == ["demonstrations"]
    with pytest.raises(UnknownNameError, match=r"arm of this study.*da-ibc-kept"):
        chosen("standard", arms=["da-ibc-kept"])


def test_ablations_of_acting_need_no_training_and_fewer_seeds() -> None:
    study = chosen("standard")
    seeds = [it.agent.seed for it in arm_agents(study) if it.arm.name == "da-ibc-cold"]
    assert seeds == [0]
    assert len([it for it in arm_agents(study) if it.arm.name == "da-ibc-sample"]) == 3


def test_ways_to_act_that_are_aside_are_looked_at_with_one_agent() -> None:
    study = chosen("standard", methods=["bc-beta"], seeds=[5, 6])
    names = [it.name for it in arm_agents(study)]
    assert names == [
        "bc-beta-mode-5",
        "bc-beta-mode-6",
        "bc-beta-sample-5",
        "bc-beta-sample-6",
        "bc-beta-committed-5",
        "bc-beta-committed-6",
        "bc-beta-mean-5",
    ]


def test_each_variant_has_one_main_arm() -> None:
    main = [it.arm for it in arm_agents(chosen("standard", seeds=[0])) if it.is_main]
    assert len(main) == len({arm.variant for arm in main}) == len(chosen("standard").variants)


def test_methods_that_a_preset_lacks_can_be_asked_for() -> None:
    assert [it.name for it in chosen("quick", methods=["flow"]).arms] == ["flow-committed"]
    assert [it.name for it in chosen("paper", methods=["diffusion"]).arms] == [
        "diffusion-committed",
        "diffusion-sample",
    ]


def test_settings_of_the_study_and_of_learners_are_changed() -> None:
    study = chosen(
        "standard",
        methods=["bc-beta", "da-ibc"],
        seeds=[4, 5],
        episodes=3,
        steps=7,
        assignments=["long_steps=0", "optimiser.epochs=5", "da-ibc:negatives.count=5"],
    )
    assert (study.episodes, study.steps, study.long_steps) == (3, 7, 0)
    assert (study.seeds, study.detail_seeds, study.ablation_seeds) == ((4, 5), (4,), (4,))
    learnt = {it.name: learner_config(it) for it in study.variants}
    assert learnt["bc-beta"].optimiser.epochs == learnt["da-ibc"].optimiser.epochs == 5
    assert learnt["da-ibc"].negatives.count == learnt["da-ibc-kde-loss"].negatives.count == 5
    assert learnt["bc-beta"].negatives.count != 5


def test_seeds_are_set_as_they_are_given() -> None:
    assert chosen("standard", assignments=["seeds=[4,5]"]) == chosen("standard", seeds=[4, 5])
    study = chosen("standard", assignments=["seeds=[4,5]", "detail_seeds=[5]"])
    assert (study.seeds, study.detail_seeds, study.ablation_seeds) == ((4, 5), (5,), (4,))


def test_what_an_ablation_changes_is_not_changed_back() -> None:
    study = chosen("standard", assignments=["network.action_gain=8"])
    learnt = {it.name: learner_config(it) for it in study.variants}
    assert learnt["da-ibc"].network.action_gain == 8
    assert learnt["da-ibc-plain-head"].network.action_gain == 1


@pytest.mark.parametrize(
    ("assignment", "said"),
    [
        ("long_step=1", "setting of a study 'long_step'.*Did you mean 'long_steps'"),
        ("long_steps", "Cannot set 'long_steps'"),
        ("flow:optimiser.epochs=1", "method of this study 'flow'"),
        ("episodes=0", "episodes is 0; expected at least 1"),
        ("steps=many", "steps"),
        ("variants=1", "setting of a study 'variants'"),
        ("detail_seeds=[7]", r"detail_seeds is \(7,\); expected some of seeds, 0"),
        ("ablation_seeds=[7]", r"ablation_seeds is \(7,\); expected some of seeds, 0"),
        ("seeds=4", "seeds"),
    ],
)
def test_changes_without_a_meaning_are_refused(assignment: str, said: str) -> None:
    with pytest.raises((ConfigError, UnknownNameError), match=said):
        chosen("quick", assignments=[assignment])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"preset": "slow"}, "study preset 'slow'"),
        ({"preset": "quick", "methods": ["ibb"]}, "method 'ibb'.*Did you mean 'ibc'"),
        ({"preset": "quick", "seeds": [1, 1]}, "seeds is .*different numbers"),
        ({"preset": "quick", "methods": []}, "expected different names"),
    ],
)
def test_studies_of_nothing_known_are_refused(given: dict[str, object], said: str) -> None:
    with pytest.raises((ConfigError, UnknownNameError), match=said):
        chosen(**given)  # type: ignore[arg-type]


def test_a_learner_setting_without_a_meaning_is_refused_by_its_arm_before_anything_runs() -> None:
    study = chosen("quick", assignments=["optimiser.epochs=0"])
    with pytest.raises(ConfigError, match="epochs is 0"):
        require_buildable(study)
