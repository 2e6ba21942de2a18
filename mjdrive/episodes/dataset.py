"""A data set: a folder of episode files and the manifest that guards them."""

import json
from collections import Counter
from pathlib import Path

from mjdrive import config
from mjdrive.datatypes import Episode
from mjdrive.episodes import store
from mjdrive.episodes.manifest import FORMAT, EpisodeEntry, Manifest
from mjdrive.episodes.recovery import DEVIATIONS, RECOVERED
from mjdrive.errors import ConfigError, DataError
from mjdrive.expert.solves import SOLVER, SOLVES
from mjdrive.town import library

MANIFEST = "manifest.json"


def describe(
    episode: Episode, *, name: str, file: str, content: bytes, collection: int = 0
) -> EpisodeEntry:
    """Make the manifest's entry for one finished episode.

    Args:
        episode: The drive.
        name: What was driven, unique in the data set.
        file: Name of its file in the folder.
        content: The file, byte for byte.
        collection: The collection that it belongs to.
    """
    counts = Counter(infraction.kind.name.lower() for infraction in episode.infractions)
    return EpisodeEntry(
        name=name,
        file=file,
        sha256=store.digest(content),
        steps=len(episode.time),
        infractions=dict(sorted(counts.items())),
        deviations=int(episode.metadata.get(DEVIATIONS, 0)),
        recovered=int(episode.metadata.get(RECOVERED, 0)),
        collection=collection,
        solver=episode.metadata.get(SOLVER, ""),
        solves=json.loads(episode.metadata.get(SOLVES, "{}")),
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


def files_of(folder: Path) -> tuple[Path, ...]:
    """Files that make up a data set: its manifest and the episodes that this lists; none if there is no manifest.

    Raises:
        DataError: If nobody can tell, because the manifest cannot be read.
    """
    path = folder / MANIFEST
    if not path.is_file():
        return ()
    try:
        manifest = read_manifest(folder)
    except DataError as error:
        raise DataError(
            f"{error} --overwrite deletes only what a manifest lists, so delete '{folder}' yourself, or give another "
            f"folder with --out."
        ) from error
    return (path, *(folder / Path(entry.file).name for entry in manifest.episodes))


def remove(folder: Path) -> None:
    """Delete the manifest and the episode files that it lists; a folder without a manifest is left alone.

    Raises:
        DataError: If the manifest cannot be read; then nothing is deleted.
    """
    for path in files_of(folder):
        path.unlink(missing_ok=True)


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
    if len(manifest.episodes) < manifest.all_planned:
        raise DataError(
            f"Data set '{folder}' has {len(manifest.episodes)} of {manifest.all_planned} episodes; its collection "
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
