"""Run folders: which there are, and which may be written to."""

from collections.abc import Iterable
from pathlib import Path

from mjdrive.errors import RunError, UnknownNameError
from mjdrive.expert import experts
from models import checkpoint

SOURCE = "source.json"
FILES = (
    SOURCE,
    checkpoint.CONFIG,
    checkpoint.STATE,
    checkpoint.MODEL,
    checkpoint.TRAINING,
    checkpoint.METRICS,
)
"""What a run folder holds."""


def is_run(folder: Path) -> bool:
    """Whether a folder holds at least one complete epoch."""
    return (folder / checkpoint.STATE).is_file()


def newest(runs: Path) -> Path | None:
    """Find the run that was trained last; None if there is none.

    Args:
        runs: Folder of run folders.
    """
    found = [folder for folder in runs.glob("*") if is_run(folder)]
    return max(
        found,
        key=lambda folder: ((folder / checkpoint.STATE).stat().st_mtime_ns, folder),
        default=None,
    )


def find(name: str, runs: Path, *, others: Iterable[str] = ()) -> Path:
    """Find a run by its folder or by its name.

    Args:
        name: A folder, or the name of a folder in `runs`.
        runs: Folder of run folders.
        others: Policies besides runs and experts that the user may have meant.

    Raises:
        UnknownNameError: If there is neither.
    """
    for folder in (Path(name), runs / name):
        if folder.is_dir():
            return folder
    known = {folder.name for folder in runs.glob("*") if is_run(folder)} | {*experts.NAMES, *others}
    raise UnknownNameError("policy", name, known, hint="A run folder will do, too.")


def require_free(run: Path) -> None:
    """Refuse to train over another run.

    Raises:
        RunError: If the folder holds one.
    """
    if is_run(run):
        raise RunError(
            f"'{run}' holds a training run already. Go on with --resume, replace it with --overwrite, "
            f"or give another folder with --out."
        )


def require_begun(run: Path) -> None:
    """Refuse to go on with a run that is not there.

    Raises:
        RunError: If the folder holds no complete epoch.
    """
    if not is_run(run):
        raise RunError(
            f"'{run}' holds no complete epoch to resume. Expected the folder of an interrupted run; "
            f"train without --resume to start one."
        )


def remove(run: Path) -> None:
    """Delete a run, but nothing else that may be in its folder."""
    for name in FILES:
        (run / name).unlink(missing_ok=True)
