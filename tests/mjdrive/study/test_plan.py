"""What a study has to do."""

import dataclasses
from pathlib import Path

import pytest

from mjdrive.config import StudyConfig
from mjdrive.datatypes import Town
from mjdrive.study import plan
from mjdrive.study.jobs import drivers
from mjdrive.study.records.folder import StudyFolder
from mjdrive.study.settings.agents import agents


def test_agents_act_as_their_arms_say(
    tiny: StudyConfig, town02: Town, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drivers, "digest", lambda run: "ab")
    runs = {it.name: tmp_path / it.name for it in agents(tiny)}
    arms = plan.plan_arms(tiny, StudyFolder(tmp_path), runs, town02, precision="float32")
    settings = {it.who.name: it.who.settings for it in arms}
    assert settings["bc-beta-sample-3"].beta.inference == "sample"
    assert settings["da-ibc-sample-3"].sampler.grid.choice == "sample"
    assert settings["da-ibc-argmin-3"].sampler.grid.choice == "argmin"
    assert {it.sampler.grid.points for it in settings.values()} == {9}  # those of the variant
    seen = {job.who for it in arms for job in (*it.all_drives, *it.forks)}
    assert seen == {it.who for it in arms}


def test_main_arms_and_those_that_say_so_make_the_long_drive(
    tiny: StudyConfig, town02: Town, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drivers, "digest", lambda run: "ab")
    mode = dataclasses.replace(tiny.arms[0], name="bc-beta-mean", acting=("beta.inference=mean",))
    arms = (tiny.arms[0], dataclasses.replace(mode, is_long=True), *tiny.arms[1:])
    config = dataclasses.replace(tiny, arms=arms)
    runs = {it.name: tmp_path / it.name for it in agents(config)}

    def long_drives(config: StudyConfig) -> list[str]:
        found = plan.plan_arms(config, StudyFolder(tmp_path), runs, town02, precision="float32")
        return [it.who.name for it in found if it.it is not None and it.long_drive is not None]

    assert long_drives(config) == ["bc-beta-sample-3", "bc-beta-mean-3", "da-ibc-sample-3"]
    assert long_drives(dataclasses.replace(config, detail_seeds=())) == []

    def changed(*, like_methods: bool) -> StudyConfig:
        others = dataclasses.replace(tiny.variants[1], change="other", like_methods=like_methods)
        variants = (tiny.variants[0], others)
        return dataclasses.replace(config, variants=variants, ablation_seeds=(3,))

    assert "da-ibc-sample-3" in long_drives(changed(like_methods=True))
    assert "da-ibc-sample-3" not in long_drives(changed(like_methods=False))
