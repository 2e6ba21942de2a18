"""A whole study of seconds: it is made once, and goes on wherever it was cut short."""

import dataclasses
import hashlib
import json
import pickle
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from mjdrive.config import StudyConfig, from_dict, read_json
from mjdrive.errors import DataError, RouteError, RunError, UnknownNameError
from mjdrive.evaluation.metrics import RED_LIGHT_FACTOR
from mjdrive.study.plan import plan_arms, plan_references
from mjdrive.study.records.folder import StudyFolder
from mjdrive.study.records.results import RESULTS, StudyRecord, StudyResults
from mjdrive.study.study import Study
from mjdrive.town import library

pytestmark = pytest.mark.timeout(
    900
)  # whole studies, one after the other, on a machine that may be busy

STAGES = ("collect", "train", "drive", "live moments again", "judge")
TIMES = ("metrics.jsonl",)
"""Files that tell how long something took, which is never twice the same."""


def quietly(stage: str, count: int) -> Callable[[str, int, int], None]:
    return lambda thing, done, expected: None


class CutShortError(Exception):
    """What a test interrupts a study with."""


def cut_in(wanted: str) -> Callable[[str, int], Callable[[str, int, int], None]]:
    """Interrupt a stage when its second thing is well under way, or when its first is done if nothing is told before."""

    def begin(stage: str, count: int) -> Callable[[str, int, int], None]:
        done_things: list[str] = []

        def report(thing: str, done: int, expected: int) -> None:
            if stage != wanted:
                return
            if done_things and done >= 2:
                raise CutShortError
            if done == expected:
                done_things.append(thing)
                if count == len(done_things) or expected == 1:
                    raise CutShortError

        return report

    return begin


def digests(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in TIMES
    }


def test_a_study_that_is_cut_short_in_every_stage_goes_on_to_the_same_bytes(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "cut"
    seen = []
    for stage in STAGES:
        with pytest.raises(CutShortError):
            Study(tiny, folder).run(cut_in(stage))
        assert not (folder / RESULTS).exists()
        seen.append(len(digests(folder)))
    assert seen == sorted(set(seen)), "each stage left something behind that was not made again"
    Study(tiny, folder).run(quietly)
    assert digests(folder) == digests(tiny_folder)


def test_a_finished_study_is_told_in_full_and_made_again_in_no_part(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "copy"
    shutil.copytree(tiny_folder, folder)
    monkeypatch.delattr("mjdrive.study.jobs.driving.Simulation")
    told: dict[str, set[str]] = {}
    counts: dict[str, int] = {}

    def stage(name: str, count: int) -> Callable[[str, int, int], None]:
        counts[name] = count
        things = told.setdefault(name, set())
        return lambda thing, done, expected: things.add(thing) if done == expected else None

    Study(tiny, folder).run(stage)
    assert digests(folder) == digests(tiny_folder)
    assert {name: len(things) for name, things in told.items()} == counts
    assert counts["train"] == 0


def test_what_was_lost_or_damaged_is_made_again(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "copy"
    shutil.copytree(tiny_folder, folder)
    for name in ("drives/expert-0/long.json", "drives/da-ibc-sample-3/episode-001.hdf5", RESULTS):
        (folder / name).unlink()
    next((folder / "landscapes").glob("bc-beta-*")).write_text("{")
    judged = folder / "judged/da-ibc-sample-3.json"
    record = json.loads(judged.read_text())
    assert record["landscapes"]
    judged.write_text(json.dumps({**record, "landscapes": []}))  # as if none had been kept
    Study(tiny, folder).run(quietly)
    assert digests(folder) == digests(tiny_folder)


def test_other_settings_versions_or_files_in_the_folder_are_refused(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path
) -> None:
    with pytest.raises(DataError, match=r"differs in steps\. Expected the same.*--out"):
        Study(dataclasses.replace(tiny, steps=13), tiny_folder).run(quietly)
    other = tmp_path / "other"
    other.mkdir()
    record = json.loads((tiny_folder / "study.json").read_text())
    record["versions"]["mujoco"] = "1.50"
    (other / "study.json").write_text(json.dumps(record))
    with pytest.raises(DataError, match="differs in versions"):
        Study(tiny, other).run(quietly)
    strange = tmp_path / "strange"
    strange.mkdir()
    (strange / "diary.txt").write_text("dear diary")
    with pytest.raises(DataError, match="holds no study"):
        Study(tiny, strange).run(quietly)
    assert [path.name for path in strange.iterdir()] == ["diary.txt"]


def test_data_and_runs_that_are_there_are_taken_and_not_made_again(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "taken"
    data = {"demonstrations": tiny_folder / "data/demonstrations"}
    results = Study(tiny, folder, data, tiny_folder / "runs").run(quietly)
    assert results == read_json(StudyResults, tiny_folder / RESULTS)
    assert not (folder / "runs").exists()
    assert not (folder / "data/demonstrations").exists()
    record = read_json(StudyRecord, folder / "study.json")
    assert set(record.runs) == {"bc-beta-3", "da-ibc-3"}


def test_runs_of_other_settings_are_refused_by_what_differs(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path
) -> None:
    changed = tuple(
        dataclasses.replace(it, assignments=(*it.assignments, "optimiser.batch_size=64"))
        for it in tiny.variants
    )
    study = Study(
        dataclasses.replace(tiny, variants=changed),
        tmp_path / "study",
        {"demonstrations": tiny_folder / "data/demonstrations"},
        tiny_folder / "runs",
    )
    with pytest.raises(RunError, match=r"optimiser\.batch_size 128 \(here 64\).*--set"):
        study.run(quietly)


def test_runs_trained_on_other_data_are_refused(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path
) -> None:
    other = dataclasses.replace(tiny, seed=1)
    with pytest.raises(RunError, match="trained on another data set"):
        Study(other, tmp_path / "study", {}, tiny_folder / "runs").run(quietly)


def test_a_town_without_a_choice_of_two_is_refused_before_anything_runs(
    tiny: StudyConfig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mjdrive.study.records.situations.approaches", lambda town: ())
    with pytest.raises(RouteError, match="no junction with two ways on"):
        Study(tiny, tmp_path / "study").run(quietly)
    assert not (tmp_path / "study").exists()


def test_data_that_nobody_learns_from_is_refused(
    tiny: StudyConfig, tiny_folder: Path, tmp_path: Path
) -> None:
    data = {"twon": tiny_folder / "data/demonstrations"}
    with pytest.raises(UnknownNameError, match="data set of the study 'twon'"):
        Study(tiny, tmp_path / "study", data).run(quietly)
    assert not (tmp_path / "study").exists()
    data = {"demonstrations": tiny_folder / "data/held-out"}
    with pytest.raises(DataError, match="driven in town02; expected town01"):
        Study(tiny, tmp_path / "study", data).run(quietly)


def test_results_hold_every_agent_way_to_act_and_reference(
    tiny: StudyConfig, tiny_folder: Path
) -> None:
    results = read_json(StudyResults, tiny_folder / RESULTS)
    assert [it.arm for it in results.references] == ["expert", "expert", "right-walker"]
    assert [(it.arm, it.seed) for it in results.arms] == [(arm.name, 3) for arm in tiny.arms]
    starts = {
        tuple(drive.seed for drive in it.drives) for it in (*results.references, *results.arms)
    }
    assert len(starts) == 1, "all drive from the same places"
    for it in (*results.references, *results.arms):
        for drive in it.drives:
            assert drive.steps == tiny.steps
            assert drive.penalty == pytest.approx(RED_LIGHT_FACTOR**drive.red_lights)
            assert drive.score == pytest.approx(drive.distance_m * drive.penalty, abs=1e-3)
    likelihoods = {it.arm: it.likelihood for it in results.arms}
    assert likelihoods["da-ibc-sample"] == likelihoods["da-ibc-argmin"], (
        "one density, two ways to act"
    )
    assert [(it.arm, it.epoch) for it in results.progress] == [
        ("bc-beta-sample", 2),
        ("bc-beta-sample", 3),
        ("da-ibc-sample", 2),
        ("da-ibc-sample", 3),
    ]
    assert len(results.paths) == 4
    assert all(
        (tiny_folder / name).is_file()
        for name in (*results.paths, *results.landscapes, *results.fans)
    )


def test_jobs_can_be_sent_to_another_process(tiny: StudyConfig, tiny_folder: Path) -> None:
    folder, town = StudyFolder(tiny_folder), library.load("town02")
    runs = {name: tiny_folder / "runs" / name for name in ("bc-beta-3", "da-ibc-3")}
    plans = (
        *plan_references(tiny, folder),
        *plan_arms(tiny, folder, runs, town, precision="float32"),
    )
    for plan in plans:
        for job in (*plan.all_drives, *plan.forks, *([plan.judge] if plan.judge else [])):
            assert pickle.loads(pickle.dumps(job)) == job
            assert hash(job) == hash(pickle.loads(pickle.dumps(job)))
    names = [job.name for plan in plans for job in (*plan.all_drives, *plan.forks)]
    assert len(set(names)) == len(names)


def test_settings_come_back_from_their_file(tiny: StudyConfig, tiny_folder: Path) -> None:
    record = json.loads((tiny_folder / "study.json").read_text())
    assert from_dict(StudyConfig, record["settings"]) == tiny
