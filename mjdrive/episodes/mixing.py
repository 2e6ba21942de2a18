"""Finds the place of a collection in a data folder: a new one, one to go on in, or one to add to."""

import dataclasses
from pathlib import Path

from mjdrive.datatypes import Town
from mjdrive.episodes import dataset
from mjdrive.episodes.manifest import Collection, Manifest
from mjdrive.errors import DataError


def find_place(
    folder: Path, town: Town, collection: Collection, *, mix: bool, overwrite: bool = False
) -> tuple[Manifest, int]:
    """Say what is in a data folder already, and where a collection belongs in it.

    Args:
        folder: Data folder, which may not exist yet.
        town: Where the collection is driven.
        collection: Its description.
        mix: Whether it may stand beside collections that were driven in another way.
        overwrite: Whether it takes the place of what is there.

    Returns:
        The manifest with the collection in it, which is not written, and its number there.

    Raises:
        DataError: If the folder holds something else, or another collection with which this one shall not be mixed.
    """
    is_doomed = overwrite and bool(dataset.files_of(folder))
    is_free = not (folder / dataset.MANIFEST).exists() and not any(folder.glob("*.hdf5"))
    if is_doomed or is_free:
        values = {
            field.name: getattr(collection, field.name) for field in dataclasses.fields(Collection)
        }
        return Manifest(town=town.name, town_digest=town.digest, **values), 0
    found = dataset.read_manifest(folder)
    other_town = [
        name
        for name, value in (("town", town.name), ("town_digest", town.digest))
        if getattr(found, name) != value
    ]
    if other_town:
        raise DataError(
            f"'{folder}' holds a data set that differs in {', '.join(other_town)}. Expected one of {town.name} as it is "
            f"installed, or a new folder. Give another folder with --out, or replace it with --overwrite."
        )
    if collection in found.collections:
        return found, found.collections.index(collection)
    if mix:
        added = dataclasses.replace(found, added=(*found.added, collection))
        return added, len(added.added)
    raise DataError(
        f"'{folder}' holds a data set that differs in {_differences(found.collections[0], collection)}. Expected a new folder "
        f"or the same collection. Give another folder with --out, replace it with --overwrite, or add to it with --mix."
    )


def _differences(found: Collection, wanted: Collection) -> str:
    """Name what differs; of settings and versions, which."""
    names = []
    for field in dataclasses.fields(Collection):
        ours, theirs = getattr(wanted, field.name), getattr(found, field.name)
        if ours == theirs:
            continue
        if isinstance(ours, dict):
            keys = sorted(key for key in {*ours, *theirs} if ours.get(key) != theirs.get(key))
            names.append(f"{field.name} ({', '.join(keys)})")
        else:
            names.append(field.name)
    return ", ".join(names)
