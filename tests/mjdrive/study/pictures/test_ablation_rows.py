"""Rows of the ablation picture, of the committed study."""

import dataclasses
from pathlib import Path

import pytest

from mjdrive.config import read_json
from mjdrive.study.pictures.ablation_rows import reference_row
from mjdrive.study.pictures.figure_looks import INK, looks
from mjdrive.study.records.reading import StudyFiles
from mjdrive.study.records.results import RESULTS, STUDY, StudyRecord, StudyResults

FOLDER = Path(__file__).resolve().parents[4] / "docs" / "results" / "ablations"


@pytest.fixture
def study() -> StudyFiles:
    record = read_json(StudyRecord, FOLDER / STUDY)
    return StudyFiles(record, read_json(StudyResults, FOLDER / RESULTS), (), (), ())


def test_the_expert_is_what_distances_are_measured_by(study: StudyFiles) -> None:
    row = reference_row(study, looks(study.record.settings))
    assert row is not None
    assert (row.label, row.colour) == ("PID expert, random walk", INK)
    distance, penalty, recall, *_ = row.intervals
    assert distance is not None
    assert (distance.value, penalty and penalty.value) == (1.0, 1.0)
    assert recall is not None
    assert recall.low < recall.value == 200 / (5 * 48) < recall.high


def test_without_the_expert_there_is_no_reference(study: StudyFiles) -> None:
    others = tuple(it for it in study.results.references if it.arm != "expert")
    alone = dataclasses.replace(
        study, results=dataclasses.replace(study.results, references=others)
    )
    assert reference_row(alone, looks(study.record.settings)) is None
