"""Runs, drives and data sets on disk, as the tabs of the page list them."""

import dataclasses
import json
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from mjdrive.datatypes import Episode
from mjdrive.episodes import store
from mjdrive.errors import DataError, MjdriveError, UnknownNameError
from mjdrive.evaluation import report
from mjdrive.web.choices import run_names
from models import checkpoint
from models.errors import ModelsError

MOST_LISTED = 500
"""Episodes in one list, the newest first [-]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Shelf:
    """The folders that a page may look into.

    Attributes:
        runs: Folder of run folders.
        drives: Folder of what `mjdrive drive` leaves.
        data: Folder of data sets.
    """

    runs: Path
    drives: Path
    data: Path

    def episodes(self) -> list[dict[str, Any]]:
        """List the episodes that can be replayed, the newest first."""
        ages = [(_age(path), name, path) for name, path in self._paths().items()]
        found = sorted((it for it in ages if it[0]), reverse=True)[:MOST_LISTED]
        return [_described(name, path, age) for age, name, path in found]

    def episode(self, name: str) -> Episode:
        """Read one episode by its name in the list; paths are not names.

        Raises:
            UnknownNameError: If it is not in the list.
            DataError: If it is damaged.
        """
        return store.read(self.file(name))

    def delete(self, name: str) -> None:
        """Delete a drive of `mjdrive drive` for good; demonstrations are parts of data sets and stay.

        Raises:
            UnknownNameError: If it is not in the list.
            DataError: If it is part of a data set.
        """
        path = self.file(name)
        if not name.startswith("drives/"):
            raise DataError(
                f"'{name}' is part of a data set, whose manifest lists it; expected a drive."
            )
        for sibling in report.FILES:
            (path.parent / sibling).unlink(missing_ok=True)
        if not any(path.parent.iterdir()):
            path.parent.rmdir()

    def run_list(self) -> list[dict[str, Any]]:
        """List the training runs with their losses by epoch."""
        return [_run(self.runs / name) for name in run_names(self.runs)]

    def drive_figures(self) -> list[dict[str, Any]]:
        """Figures of all drives, for the table that compares policies."""
        found = sorted(self.drives.glob(f"**/{report.SUMMARY}"))[-MOST_LISTED:]
        return [it for it in map(_figures, found) if it is not None]

    def file(self, name: str) -> Path:
        """Find the file of an episode by its name in the list; paths are not names.

        Raises:
            UnknownNameError: If it is not in the list.
        """
        paths = self._paths()
        if name not in paths:
            raise UnknownNameError("episode", name, (), hint="Load the list again.")
        return paths[name]

    def _paths(self) -> dict[str, Path]:
        return {
            f"{root.name}/{path.relative_to(root).with_suffix('').as_posix()}": path
            for root in (self.drives, self.data)
            for path in _whole_files(root)
        }


def _whole_files(root: Path) -> Iterator[Path]:
    """Episode files in a folder that links do not lead out of."""
    whole = root.resolve()
    for path in root.glob("**/*.hdf5"):
        if path.resolve().is_relative_to(whole) and not path.name.startswith("."):
            yield path


def _age(path: Path) -> int:
    """When a file was written [ns]; 0 if it is there no longer."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


@lru_cache(maxsize=2 * MOST_LISTED)
def _described(name: str, path: Path, age: int) -> dict[str, Any]:
    """A row of the list; a file that has not changed is not read again."""
    del age
    try:
        return {"name": name, **_about(store.read(path))}
    except MjdriveError as error:
        return {"name": name, "error": str(error)}


def _figures(path: Path) -> dict[str, Any] | None:
    """The summary of a drive; None if it has been deleted or damaged since."""
    try:
        found = json.loads(path.read_text())
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) else None


def _about(episode: Episode) -> dict[str, Any]:
    steps = np.linalg.norm(np.diff(episode.vehicle[:, :2], axis=0), axis=1)
    return {
        "town": episode.town,
        "policy": episode.policy,
        "seed": episode.seed,
        "source": episode.metadata.get("source", "drive"),
        "steps": len(episode.time),
        "duration": round(float(episode.time[-1] - episode.time[0]), 1),
        "distance": round(float(steps.sum()), 1),
        "infractions": len(episode.infractions),
    }


def _run(folder: Path) -> dict[str, Any]:
    """A run in a line, with its curve."""
    try:
        state = checkpoint.load_state(folder)
        lines = (folder / checkpoint.METRICS).read_text().splitlines()
        epochs = [json.loads(line) for line in lines]
    except (OSError, ValueError, ModelsError) as error:
        return {"name": folder.name, "error": str(error)}
    return {"name": folder.name, "method": state.method, "seed": state.seed, "epochs": epochs}
