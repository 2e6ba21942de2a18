import dataclasses

import pytest

from mjdrive.config import Variant
from mjdrive.learning.settings import learner_settings
from mjdrive.study.settings.ablations import (
    ABLATIONS,
    ACTING_ABLATIONS,
    LONG_STEEP,
    QUARTER,
)
from mjdrive.study.settings.agents import learner_config
from models.config import LearnerConfig, is_idle

STUDYS = learner_config(Variant("da-ibc", "da-ibc", assignments=LONG_STEEP))


def differences(one: object, other: object, prefix: str = "") -> set[str]:
    found: set[str] = set()
    for field in dataclasses.fields(one):  # type: ignore[arg-type]
        first, second, name = (
            getattr(one, field.name),
            getattr(other, field.name),
            prefix + field.name,
        )
        if dataclasses.is_dataclass(first):
            found |= differences(first, second, f"{name}.")
        elif first != second:
            found.add(name)
    return found


def learning_differences(one: LearnerConfig, other: LearnerConfig) -> set[str]:
    acting = ("sampler.", "commitment.")
    return {
        it for it in differences(one, other) if not is_idle(it, one) and not it.startswith(acting)
    }


@pytest.mark.parametrize("ablation", ABLATIONS, ids=lambda it: it.name)
def test_each_ablation_learns_in_another_way_and_says_how(ablation: Variant) -> None:
    assert ablation.change
    base = STUDYS if ablation is QUARTER else learner_config(QUARTER)
    assert ablation.base == ("da-ibc" if ablation is QUARTER else QUARTER.name)
    changed = learning_differences(learner_config(ablation), base)
    assert changed or ablation.demonstrations != "demonstrations"
    if ablation.name not in {"da-ibc-papers", "da-ibc-papers-negatives"}:
        assert len(changed) <= 2


@pytest.mark.parametrize("ablation", ABLATIONS, ids=lambda it: it.name)
def test_ablations_of_training_learn_for_as_many_steps_as_each_other(ablation: Variant) -> None:
    walked = 1_181_041
    samples = {"demonstrations": walked, "undisturbed": walked, "routes": 23_260}
    optimiser = learner_config(ablation).optimiser
    steps = optimiser.epochs * optimiser.steps_per_epoch(samples[ablation.demonstrations])
    assert steps == pytest.approx(4614, rel=0.03)


def test_what_has_all_of_the_papers_choices_differs_from_it_in_the_optimiser_alone() -> None:
    (papers,) = [it for it in ABLATIONS if it.name == "da-ibc-papers"]
    changed = learning_differences(
        learner_config(papers), learner_settings("da-ibc", preset="paper")
    )
    assert changed
    assert all(it.startswith("optimiser.") for it in changed), changed


def test_every_ablation_drives_as_the_study_does() -> None:
    assert {it.name for it in ABLATIONS} <= {it.variant for it in ACTING_ABLATIONS}
