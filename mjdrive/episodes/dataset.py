"""A data set: a folder of episode files and the manifest that describes and guards them."""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mjdrive import config
from mjdrive.datatypes import Episode
from mjdrive.episodes import store
from mjdrive.errors import ConfigError, DataError
from mjdrive.town import library
from mjdrive.vehicle import cars

FORMAT = "mjdrive-dataset-1"
MANIFEST = "manifest.json"


@dataclass(frozen=True, slots=True)
class EpisodeEntry:
    """One episode of a data set.

    Attributes:
        name: What was driven, unique in the data set.
        file: Name of the episode file in the folder.
        sha256: Digest of the file, hexadecimal.
        steps: Control steps in the episode [-].
        infractions: How often each kind of infraction happened; kinds that did not are left out.
    """

    name: str
    file: str
    sha256: str
    steps: int
    infractions: dict[str, int]


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a data set is made from and consists of.

    Attributes:
        town: Name of the town.
        town_digest: Digest of the town that was driven.
        seed: Seed of the collection [-].
        settings: Settings of the collection, as JSON values.
        versions: Versions of the software that drove.
        car: Name of the car that drove; data sets from before one could choose were driven with the default car.
        car_digest: Digest of its MJCF.
        num_planned: Episodes in the whole data set; more than are listed while it is being collected [-].
        episodes: Finished episodes, in the order in which they were driven.
        format: Version of this description.
    """

    town: str
    town_digest: str
    seed: int
    settings: dict[str, Any]
    versions: dict[str, str]
    num_planned: int
    episodes: tuple[EpisodeEntry, ...] = ()
    car: str = cars.DEFAULT
    car_digest: str = ""
    format: str = FORMAT


def describe(episode: Episode, *, name: str, file: str, content: bytes) -> EpisodeEntry:
    """Make the manifest's entry for one finished episode.

    Args:
        episode: The drive.
        name: What was driven, unique in the data set.
        file: Name of its file in the folder.
        content: The file, byte for byte.
    """
    counts = Counter(infraction.kind.name.lower() for infraction in episode.infractions)
    return EpisodeEntry(
        name=name,
        file=file,
        sha256=store.digest(content),
        steps=len(episode.time),
        infractions=dict(sorted(counts.items())),
    )


def write_manifest(manifest: Manifest, folder: Path) -> None:
    """Write the description of a data set into its folder."""
    config.write_json(manifest, folder / MANIFEST)


def read_manifest(folder: Path) -> Manifest:
    """Read the description of a data set, finished or not.

    Raises:
        DataError: If the folder is missing, holds no manifest, or one of another format.
    """
    path = folder / MANIFEST
    if not path.is_file():
        found = "is no data set (it has no manifest.json)" if folder.is_dir() else "does not exist"
        raise DataError(
            f"Data folder '{folder}' {found}. Make one with `mjdrive collect --town town01`, "
            f"or name another folder with --data."
        )
    try:
        manifest = config.read_json(Manifest, path)
    except ConfigError as error:
        raise DataError(
            f"'{path}' is no manifest of format {FORMAT}: {error} Collect the data set again."
        ) from error
    if manifest.format != FORMAT:
        raise DataError(
            f"'{path}' has format '{manifest.format}'; expected '{FORMAT}'. Collect the data set again."
        )
    return manifest


def digest(folder: Path) -> str:
    """SHA-256 of the manifest, and so of everything in the data set, hexadecimal."""
    return store.digest((folder / MANIFEST).read_bytes())


def remove(folder: Path) -> None:
    """Delete the manifest and the episode files of a data set; a folder without a manifest is left alone."""
    if (folder / MANIFEST).is_file():
        for path in folder.glob("*.hdf5"):
            path.unlink()
        (folder / MANIFEST).unlink()


def read_dataset(folder: Path) -> tuple[Manifest, list[Episode]]:
    """Read a finished data set and check every file of it.

    Args:
        folder: Folder that `mjdrive collect` made.

    Returns:
        The manifest and the episodes in its order.

    Raises:
        DataError: If the folder is missing or unfinished, a file is damaged, or the town has changed since.
        UnknownNameError: If the town is not installed.
    """
    manifest = read_manifest(folder)
    installed = library.load(manifest.town).digest
    if manifest.town_digest != installed:
        raise DataError(
            f"Data set '{folder}' was driven in {manifest.town} {_short(manifest.town_digest)}; installed is "
            f"{_short(installed)}, another map or town format. Collect it again: "
            f"`mjdrive collect --town {manifest.town} --overwrite`."
        )
    if len(manifest.episodes) < manifest.num_planned:
        raise DataError(
            f"Data set '{folder}' has {len(manifest.episodes)} of {manifest.num_planned} episodes; its collection "
            f"was interrupted. Run the same `mjdrive collect` again: it goes on from here."
        )
    return manifest, [read_episode(folder, entry) for entry in manifest.episodes]


def read_episode(folder: Path, entry: EpisodeEntry) -> Episode:
    """Read one episode of a data set.

    Raises:
        DataError: If its file is missing or is not the one that the manifest lists.
    """
    path = folder / entry.file
    episode = store.read(path)
    if not is_intact(folder, entry):
        raise DataError(
            f"'{path}' is not the file that {MANIFEST} lists (SHA-256 {_short(entry.sha256)}). Restore it, or "
            f"delete it and run the same `mjdrive collect` again."
        )
    return episode


def is_intact(folder: Path, entry: EpisodeEntry) -> bool:
    """Whether the file of an entry is there, byte for byte."""
    path = folder / entry.file
    return path.is_file() and store.digest(path.read_bytes()) == entry.sha256


def _short(digest: str) -> str:
    """The first characters of a digest, for people."""
    return digest[:12]
