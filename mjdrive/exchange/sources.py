"""Where the drives of an export come from: an episode file, a drive, or a folder of either."""

from pathlib import Path
from typing import NamedTuple

from mjdrive.datatypes import Episode
from mjdrive.episodes import store
from mjdrive.errors import DataError
from mjdrive.evaluation.report import EPISODE

SUFFIX = ".hdf5"
"""Episode files end so."""


class Recording(NamedTuple):
    """A drive with a name.

    Attributes:
        name: Unique among those of an export; fit for a file.
        episode: The drive.
        car: Name or MJCF file of the car; what the episode says if None.
    """

    name: str
    episode: Episode
    car: str | None = None


def find(source: Path) -> tuple[Path, ...]:
    """Find the episode files that somebody means.

    Args:
        source: An episode file, the folder of a drive, or a folder of drives or of episode files.

    Returns:
        The files, in the order of their names.

    Raises:
        DataError: If there is none.
    """
    if source.is_file():
        return (source,)
    if not source.is_dir():
        raise DataError(
            f"'{source}' does not exist. Expected an episode file, or the folder of a drive, of drives or of a data set: what "
            f"`mjdrive drive` or `mjdrive collect` wrote."
        )
    if (source / EPISODE).is_file():
        return (source / EPISODE,)
    found = sorted([*source.glob(f"*{SUFFIX}"), *source.glob(f"*/{EPISODE}")])
    if not found:
        raise DataError(
            f"'{source}' holds no episode. Expected files *{SUFFIX}, or folders with {EPISODE}: what `mjdrive drive` or "
            f"`mjdrive collect` wrote."
        )
    return tuple(found)


def read(source: Path, *, car: str | None = None) -> list[Recording]:
    """Read all episodes that somebody means.

    Args:
        source: As in `find`.
        car: Name or MJCF file of the car of all of them; what each episode says if None.

    Raises:
        DataError: If there is none, or a file is damaged.
    """
    return [Recording(_name(path), store.read(path), car) for path in find(source)]


def _name(path: Path) -> str:
    """Name of a drive: that of its folder where all files are called alike, else that of the file."""
    return path.resolve().parent.name if path.name == EPISODE else path.stem
