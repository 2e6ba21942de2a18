"""A study goes on with what it began with, and with nothing else."""

import dataclasses
from pathlib import Path

import pytest

from mjdrive.config import StudyConfig, read_json
from mjdrive.errors import DataError
from mjdrive.study.records.folder import begin
from mjdrive.study.records.results import STUDY, StudyRecord


@pytest.fixture
def record(tiny: StudyConfig) -> StudyRecord:
    return StudyRecord(
        settings=tiny,
        learners={},
        versions={"mjdrive": "1.0"},
        code="12" * 32,
        precision="float32",
        device="cpu",
        towns={"town01": "cd" * 32},
        car="ef" * 32,
    )


def test_a_study_goes_on_only_with_the_code_that_began_it(
    record: StudyRecord, tmp_path: Path
) -> None:
    begin(tmp_path / "study", record)
    begin(tmp_path / "study", record)
    changed = dataclasses.replace(record, code="ab" * 32)
    with pytest.raises(DataError, match=r"begun with other code .*121212121212.*abababababab"):
        begin(tmp_path / "study", changed)


def test_a_study_does_not_go_on_on_another_kind_of_device(
    record: StudyRecord, tmp_path: Path
) -> None:
    begin(tmp_path / "study", record)
    with pytest.raises(DataError, match="differs in device"):
        begin(tmp_path / "study", dataclasses.replace(record, device="cuda"))


def test_a_study_does_not_go_on_in_another_number_format(
    record: StudyRecord, tmp_path: Path
) -> None:
    begin(tmp_path / "study", record)
    with pytest.raises(DataError, match="differs in precision"):
        begin(tmp_path / "study", dataclasses.replace(record, precision="bfloat16"))


def test_a_study_may_go_on_with_another_command_and_keeps_the_first(
    record: StudyRecord, tmp_path: Path
) -> None:
    begin(tmp_path, dataclasses.replace(record, command="mjdrive study"))
    begin(tmp_path, dataclasses.replace(record, command="mjdrive study --jobs 2"))
    assert read_json(StudyRecord, tmp_path / STUDY).command == "mjdrive study"
