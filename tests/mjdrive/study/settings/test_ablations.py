import dataclasses

import pytest
import torch

from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig, Variant
from mjdrive.datatypes import Town
from mjdrive.learning.settings import learner_settings
from mjdrive.study.records.situations import situations
from mjdrive.study.settings.ablations import (
    ABLATIONS,
    ACTING_ABLATIONS,
    KDE,
    KDE_ARMS,
    LONG_STEEP,
    QUARTER,
)
from mjdrive.study.settings.agents import learner_config
from mjdrive.study.settings.presets import ARMS
from models.config import LearnerConfig, is_idle
from models.learners import build_learner

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


def test_da_ibc_by_1_kde_differs_from_the_studys_by_that_alone_and_acts_alike() -> None:
    assert learning_differences(learner_config(KDE), STUDYS) == {"density.weighting"}
    ways = {arm.name.removeprefix("da-ibc-kde-"): set(arm.acting) for arm in KDE_ARMS}
    studys = {arm.name.removeprefix("da-ibc-"): set(arm.acting) for arm in ARMS}
    assert ways == {name: studys[name] for name in ("committed", "sample", "argmin")}


def test_lights_without_a_history_are_drawn_as_they_are_now(town02: Town) -> None:
    """The network looks away; a view that is drawn without a history looks the same to one that does not."""
    (ablation,) = [it for it in ABLATIONS if it.name == "da-ibc-lights-now"]
    (red,) = [it for it in situations(town02) if it.name == "red"]
    blind, seeing = (
        build_learner(learner_config(it), seed=0).encoder for it in (ablation, QUARTER)
    )
    features = {}
    for age in range(0, 150, 5):  # s / 10, until the light is no longer red
        moment = dataclasses.replace(red, light_phase=red.light_phase + age / 10)
        for name, steps in {"history": (15, 8, 0), "now": (0, 0, 0)}.items():
            projector = BevProjector(town02, config=BevConfig(history_steps=steps))
            seen = moment.observe(projector)
            bev, state = torch.tensor(seen.bev)[None], torch.tensor(seen.state)[None]
            features[name] = blind(bev, state), seeing(bev, state)
        assert torch.equal(features["history"][0], features["now"][1])
        if not torch.equal(features["history"][1], features["now"][1]):
            return
    pytest.fail("the light never changes")
