"""New town folders: whole, or not there at all."""

import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np

from mjdrive.config import require, write_json
from mjdrive.datatypes import Town
from mjdrive.errors import NameTakenError, RouteError
from mjdrive.town import library
from mjdrive.town.demonstrations import Waypoints, demonstration_routes
from mjdrive.town.settings import TownSettings

NUM_ROUTES = 10
"""Routes for demonstrations in a new town [-], as many as the paper's Town01 set has."""

ROUTE_LENGTH = 800.0
"""Their length [m]; the paper's are 811 m on average."""

UNFINISHED = ".unfinished-town-"
"""How the names of hidden folders begin in which towns are made."""

_ABANDONED = 24 * 3600.0
"""Age from which nobody works in such a folder any more [s]."""

_NAME = re.compile(r"[a-z][a-z0-9_-]*")


@contextmanager
def new_town_folder(name: str, *, parent: Path = library.OWN_TOWNS) -> Iterator[Path]:
    """Make the folder of a new town: it takes its place when the block ends, and is gone if the block fails.

    Args:
        name: Name of the town: a letter, then letters, digits, "-" and "_", all small.
        parent: Where it will be.

    Yields:
        A folder of that name in a hidden place beside it, to be filled.

    Raises:
        ConfigError: If the name is none for a town.
        NameTakenError: If there is a town of that name, or a folder in its place.
    """
    require_new_name(name, parent=parent)
    parent.mkdir(parents=True, exist_ok=True)
    _sweep(parent)
    hidden = Path(tempfile.mkdtemp(prefix=UNFINISHED, dir=parent))
    try:
        folder = hidden / name
        folder.mkdir()
        yield folder
        require_new_name(name, parent=parent)  # somebody else may have been quicker
        os.rename(folder, parent / name)  # noqa: PTH104  Path.rename replaces an empty folder
    finally:
        shutil.rmtree(hidden, ignore_errors=True)


def _sweep(parent: Path) -> None:
    """Remove what commands that were killed have left; those that still run are younger."""
    for folder in parent.glob(f"{UNFINISHED}*"):
        if time.time() - folder.stat().st_mtime > _ABANDONED:
            shutil.rmtree(folder, ignore_errors=True)


def require_new_name(name: str, *, parent: Path = library.OWN_TOWNS) -> None:
    """Refuse a name that no new town can have.

    Args:
        name: Name of the town.
        parent: Where its folder will be.

    Raises:
        ConfigError: If the name is none for a town.
        NameTakenError: If there is a town of that name, or a folder in its place.
    """
    require(
        _NAME.fullmatch(name) is not None,
        f"A town cannot be called '{name}'; expected a small letter, then small letters, digits, '-' and '_'.",
    )
    if name in library.town_names():
        raise NameTakenError(
            f"There is a town '{name}' already, in '{library.folder_of(name)}'. Choose another name, or remove "
            "that folder first."
        )
    if (parent / name).exists():
        raise NameTakenError(
            f"'{parent / name}' is there already. Choose another name, or remove it first."
        )


def fill(folder: Path, document: bytes, town: Town, settings: TownSettings, *, seed: int) -> Town:
    """Write map.xodr and town.json; a town without routes gets some, so that demonstrations can be collected.

    Args:
        folder: Empty folder of the town.
        document: OpenDRIVE map.
        town: What was built from it, without a digest.
        settings: What town.json shall say.
        seed: Decides the routes.

    Returns:
        The town as it will be loaded.
    """
    if not settings.routes:
        settings = replace(settings, routes=found_routes(town, seed=seed))
    (folder / library.MAP_FILE).write_bytes(document)
    write_json(settings, folder / library.SETTINGS_FILE)
    return replace(town, digest=library.digest_of(folder))


def found_routes(town: Town, *, seed: int) -> dict[str, Waypoints]:
    """Find routes; none where nobody can drive that far, which `mjdrive towns check` explains."""
    rng = np.random.default_rng(seed)
    try:
        return demonstration_routes(town, num_routes=NUM_ROUTES, length=ROUTE_LENGTH, rng=rng)
    except RouteError:
        return {}
