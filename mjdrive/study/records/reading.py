"""A finished study as its files tell it: all that pictures and the report are made from."""

from dataclasses import dataclass
from pathlib import Path

from mjdrive.config import read_json
from mjdrive.study.records import results
from mjdrive.study.records.fans import FanRecord
from mjdrive.study.records.results import DrivenPath, LandscapeRecord, StudyRecord, StudyResults


@dataclass(frozen=True, slots=True)
class StudyFiles:
    """What the JSON files of a study hold.

    Attributes:
        record: Settings and versions.
        results: Every figure.
        landscapes: What agents think of all actions, in the order of the results.
        paths: Where long drives led, likewise.
        fans: Moments lived many times, likewise.
    """

    record: StudyRecord
    results: StudyResults
    landscapes: tuple[LandscapeRecord, ...]
    paths: tuple[DrivenPath, ...]
    fans: tuple[FanRecord, ...]


def read_study(folder: Path) -> StudyFiles:
    """Read a study.

    Args:
        folder: That `mjdrive study` made.

    Raises:
        ConfigError: If a file is missing or does not hold what it should.
    """
    found = read_json(StudyResults, folder / results.RESULTS)
    return StudyFiles(
        record=read_json(StudyRecord, folder / results.STUDY),
        results=found,
        landscapes=tuple(read_json(LandscapeRecord, folder / name) for name in found.landscapes),
        paths=tuple(read_json(DrivenPath, folder / name) for name in found.paths),
        fans=tuple(read_json(FanRecord, folder / name) for name in found.fans),
    )
