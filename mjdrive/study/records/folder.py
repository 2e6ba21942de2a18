"""The folder of a study: where everything is, and whether it is the study that one means to go on with."""

from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from mjdrive import config
from mjdrive.errors import ConfigError, DataError
from mjdrive.study.records.results import STUDY, StudyRecord

HELD_OUT = "held-out"
"""Name of the expert's walk through the town that agents drive in."""

Record = TypeVar("Record")


@dataclass(frozen=True, slots=True)
class StudyFolder:
    """Names of the places in a study.

    Attributes:
        path: Its folder.
    """

    path: Path

    def data(self, name: str) -> Path:
        """Folder of a data set that the study collects."""
        return self.path / "data" / name

    def run(self, agent: str) -> Path:
        """Run folder of an agent that the study trains."""
        return self.path / "runs" / agent

    def drive(self, who: str, name: str) -> Path:
        """File of a drive without its ending."""
        return self.path / "drives" / who / name

    def forks(self, who: str, index: int) -> Path:
        """File of what was made of a moment before a junction."""
        return self.path / "forks" / f"{who}-{index}.json"

    def judged(self, who: str) -> Path:
        """File of likelihood and landscape of an agent in one way to act."""
        return self.path / "judged" / f"{who}.json"


def begin(folder: Path, record: StudyRecord) -> None:
    """Make the folder of a study, or make sure that it is that of the same study.

    Args:
        folder: New, or that of a study which goes on.
        record: What the study is.

    Raises:
        DataError: If the folder holds another study or something else.
    """
    path = folder / STUDY
    if not path.is_file():
        if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
            raise DataError(
                f"'{folder}' is there already and holds no study. Expected a new folder, or that of a study to go on "
                f"with. Give another one with --out."
            )
        config.write_json(record, path)
        return
    try:
        found = config.read_json(StudyRecord, path)
    except ConfigError as error:
        raise DataError(
            f"'{path}' is no record of a study of this version: {error} Give another folder with --out."
        ) from error
    differing = _differing(found, record)
    if differing == ["code"]:
        raise DataError(
            f"The study in '{folder}' was begun with other code of mjdrive and models (digest {found.code[:12]}); here it "
            f"is {record.code[:12]}. Expected the same, as figures of two codes do not belong into one table. Go on with "
            f"the code that began it, or give another folder with --out."
        )
    if differing:
        raise DataError(
            f"'{folder}' holds another study: it differs in {', '.join(differing)}. Expected the same, to go on with it. "
            f"Give another folder with --out, or the same options as before."
        )


def read(kind: type[Record], path: Path) -> Record | None:
    """Read a JSON file of a study; None if it is not there or not whole, so that it is made again."""
    if not path.is_file():
        return None
    try:
        return config.read_json(kind, path)
    except ConfigError:
        return None


def _differing(found: StudyRecord, wanted: StudyRecord) -> list[str]:
    """Names of what two studies do not have in common."""
    names = [name for name in StudyRecord.__slots__ if name not in ("settings", "command")]
    differing = [name for name in names if getattr(found, name) != getattr(wanted, name)]
    settings = type(found.settings).__slots__
    return differing + [
        name for name in settings if getattr(found.settings, name) != getattr(wanted.settings, name)
    ]
