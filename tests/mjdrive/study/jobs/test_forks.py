"""When a moment has to be lived again."""

import dataclasses
from pathlib import Path

import pytest

from mjdrive.config import write_json
from mjdrive.study.jobs.drivers import Who
from mjdrive.study.jobs.forks import ForkJob, ForkRecord, read_record
from mjdrive.study.records.fans import FanPath, FanRecord
from mjdrive.study.records.results import Turn

PATHS = (
    FanPath("left", True, ()),
    FanPath("left", True, ()),
    FanPath("right", False, ()),  # taken, but something was hit
    FanPath("", True, ()),  # stopped
)


@pytest.fixture
def job(tmp_path: Path) -> ForkJob:
    """A moment whose turns are kept."""
    return ForkJob(
        who=Who("a", digest="ab"),
        arm="a",
        agent_seed=0,
        approach="approach",
        file=tmp_path / "forks/a-0.json",
        turns=tmp_path / "turns",
        num_rollouts=len(PATHS),
        seed=0,
    )


def keep(
    job: ForkJob, *exits: str, paths: tuple[FanPath, ...] = PATHS, are_there: bool = True
) -> None:
    """Write a record with turns through some exits."""
    turns = tuple(Turn("a", 0, "approach", it, it, f"turns/{it}.hdf5") for it in exits)
    fan = FanRecord("a", 0, "town02", "approach", ("left", "right"), paths)
    write_json(ForkRecord("ab", None, fan, turns), job.file)
    for it in turns if are_there else ():
        place = job.file.parents[1] / it.file
        place.parent.mkdir(exist_ok=True)
        place.touch()


def test_a_moment_that_was_lived_without_keeping_turns_is_lived_again_where_they_are_wanted(
    job: ForkJob,
) -> None:
    keep(job)
    assert read_record(dataclasses.replace(job, turns=None)) is not None
    assert read_record(job) is None


def test_a_moment_whose_turns_are_there_is_not_lived_again(job: ForkJob) -> None:
    keep(job, "left")
    assert read_record(job) is not None
    assert read_record(dataclasses.replace(job, turns=None)) is not None


def test_a_moment_from_which_no_exit_was_taken_safely_has_no_turns_to_keep(job: ForkJob) -> None:
    keep(job, paths=PATHS[2:])
    assert read_record(job) is not None


def test_a_moment_whose_turns_were_lost_is_lived_again(job: ForkJob) -> None:
    keep(job, "left", are_there=False)
    assert read_record(job) is None
