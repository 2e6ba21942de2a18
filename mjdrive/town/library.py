"""Find and load towns: those that come with mjdrive, and the user's own in the folder towns/."""

import hashlib
import platform
from functools import lru_cache
from pathlib import Path

from mjdrive import plugins
from mjdrive.config import read_json
from mjdrive.datatypes import Town
from mjdrive.errors import PluginError, TownFormatError, UnknownNameError, WorkerError
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.settings import TownSettings

MAP_FILE = "map.xodr"
SETTINGS_FILE = "town.json"
PICTURE_FILE = "map.png"

OWN_TOWNS = Path("towns")
"""Where imported and generated towns go, beside data/, runs/ and drives/ in the working folder."""


def towns_folder() -> Path:
    """Find the folder of the towns that come with mjdrive: in the checkout, or inside an installed package.

    Raises:
        TownFormatError: If neither is there.
    """
    package = Path(__file__).resolve().parent.parent
    places = (package.parent / "assets" / "towns", package / "assets" / "towns")
    for place in places:
        if place.is_dir():
            return place
    searched = " and ".join(f"'{place}'" for place in places)
    raise TownFormatError(
        f"Found no towns in {searched}. Install mjdrive again, or work in a whole checkout."
    )


def shipped_names() -> tuple[str, ...]:
    """List the towns that come with mjdrive, in alphabetical order."""
    return _names_in(towns_folder())


def town_names() -> tuple[str, ...]:
    """List the towns that can be loaded by name here, in alphabetical order."""
    return tuple(sorted({*shipped_names(), *_names_in(OWN_TOWNS), *plugins.names("town")}))


def _names_in(folder: Path) -> tuple[str, ...]:
    names = (path.parent.name for path in folder.glob(f"*/{MAP_FILE}"))
    return tuple(sorted(name for name in names if not name.startswith(".")))


def folder_of(name: str) -> Path:
    """Find the folder of a town; one that comes with mjdrive goes before one of the user's, that before a package's.

    Raises:
        UnknownNameError: If there is no town of that name.
        PluginError: If the package that brings it along is broken.
    """
    for folder in (towns_folder(), OWN_TOWNS):
        if name in _names_in(folder):
            return folder / name
    if name in plugins.names("town"):
        return _folder_in_package(name)
    raise UnknownNameError(
        "town",
        name,
        town_names(),
        hint=f"Towns are folders in '{towns_folder()}' and in '{OWN_TOWNS}' where you work; "
        "`mjdrive towns import` makes one from an OpenDRIVE map.",
    )


def _folder_in_package(name: str) -> Path:
    """Folder of a town that an entry point `mjdrive.towns` names."""
    folder = plugins.load("town", name)
    if not (isinstance(folder, Path) and folder.name == name and (folder / MAP_FILE).is_file()):
        raise PluginError(
            f"The town '{name}' of {plugins.source('town', name)} is {folder!r}; expected the pathlib.Path of a folder of "
            f"that name with {MAP_FILE} and {SETTINGS_FILE}."
        )
    return folder


def load(name: str) -> Town:
    """Load a town by name; a second call gives the same object while its files are the same.

    Args:
        name: One of `town_names()`.

    Returns:
        The town.

    Raises:
        UnknownNameError: If there is no town of that name.
        TownFormatError: If its map cannot be driven.
        ConfigError: If its town.json cannot be read.
    """
    folder = folder_of(name).resolve()
    written = [
        path.stat().st_mtime_ns
        for path in (folder / MAP_FILE, folder / SETTINGS_FILE)
        if path.is_file()
    ]
    return _load_cached(folder, *written)


@lru_cache(maxsize=8)
def _load_cached(folder: Path, *written: int) -> Town:
    """Load a folder once for each time that its files were written [ns]."""
    return load_folder(folder)


def require_same(town: Town) -> None:
    """Refuse to drive in a town whose folder is not, on this machine and by now, that which it was loaded from.

    Args:
        town: As it was loaded, perhaps elsewhere; its scenery is read from its folder here.

    Raises:
        WorkerError: If its folder is missing here, or its files differ.
    """
    try:
        found = digest_of(folder_of(town.name))
    except (UnknownNameError, OSError):
        found = "missing"
    if found != town.digest:
        raise WorkerError(
            f"On the machine '{platform.node()}' the town '{town.name}' is {found}; expected the files that it was "
            f"loaded from, {town.digest}. Put its folder at the same place on all machines."
        )


def load_settings(name: str) -> TownSettings:
    """Read the light timing, routes and scenery of a town.

    Raises:
        UnknownNameError: If there is no town of that name.
        ConfigError: If its town.json cannot be read.
    """
    return read_json(TownSettings, folder_of(name) / SETTINGS_FILE)


def load_folder(folder: Path) -> Town:
    """Load a town from any folder that holds map.xodr and town.json.

    Args:
        folder: The folder; its name is the name of the town.

    Returns:
        The town.

    Raises:
        TownFormatError: If a file is missing or the map cannot be driven.
        ConfigError: If town.json cannot be read.
    """
    for file in (MAP_FILE, SETTINGS_FILE):
        if not (folder / file).is_file():
            raise TownFormatError(
                f"Town folder '{folder}' has no {file}; expected {MAP_FILE} and {SETTINGS_FILE}."
            )
    settings = read_json(TownSettings, folder / SETTINGS_FILE)
    road_map = opendrive.read(folder / MAP_FILE, flatten=settings.flatten)
    road_map = opendrive.moved(road_map, settings.origin)
    name = folder.resolve().name
    return build_town(road_map, name=name, timing=settings.lights, digest=digest_of(folder))


def digest_of(folder: Path) -> str:
    """SHA-256 of the map and of town.json in a folder, hexadecimal."""
    parts = [(folder / file).read_bytes() for file in (MAP_FILE, SETTINGS_FILE)]
    return hashlib.sha256(b"\0".join(parts)).hexdigest()
