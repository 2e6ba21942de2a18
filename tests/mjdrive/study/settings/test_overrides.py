"""What the command line changes of a study."""

import pytest

from mjdrive.errors import ConfigError, UnknownNameError
from mjdrive.study.settings import presets
from mjdrive.study.settings.agents import (
    agents,
    arm_agents,
    learner_config,
    require_buildable,
)
from mjdrive.study.settings.overrides import chosen
from models.config import METHODS


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


def test_what_acts_in_none_of_the_ways_that_are_kept_is_not_trained() -> None:
    study = chosen("standard", arms=["da-ibc-committed", "bc-beta-sample"])
    assert [it.name for it in study.arms] == ["bc-beta-sample", "da-ibc-committed"]
    assert [it.name for it in study.variants] == ["bc-beta", "da-ibc"]
    assert [it.name for it in study.demonstrations] == ["demonstrations"]
    with pytest.raises(UnknownNameError, match=r"arm of this study.*da-ibc-kept"):
        chosen("standard", arms=["da-ibc-kept"])


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


def test_landscapes_show_draws_of_the_papers_search_unless_those_of_the_arms_are_wanted() -> None:
    assert {chosen(name).landscape_draws for name in presets.PRESETS} == {"dfo"}
    assert chosen("quick", assignments=["landscape_draws=own"]).landscape_draws == "own"


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
        ("landscape_draws=dof", "landscape_draws"),
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
