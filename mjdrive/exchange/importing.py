"""Other people's demonstrations -> a data set that `mjdrive train --data` takes.

An episode of ours holds where the car was and when; views are drawn again from that. So only demonstrations that say as
much can be taken over: pictures alone cannot.
"""

import dataclasses
import importlib
import shutil
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from mjdrive import versions
from mjdrive.datatypes import Episode
from mjdrive.episodes import dataset, store
from mjdrive.episodes.manifest import Manifest
from mjdrive.errors import DataError, UnknownNameError
from mjdrive.exchange.sources import Recording
from mjdrive.recording.playback import car_of, town_of

SOURCES = {"minari": "mjdrive.exchange.from_minari", "carla-bc": "mjdrive.exchange.from_carla_bc"}
"""Module that reads each kind of demonstrations."""

IMPORTED = "imported_from"
"""Under this name `Episode.metadata` and the settings of the manifest say where they come from."""


def known(name: str) -> Callable[[Path], list[Recording]]:
    """Find what reads a kind of demonstrations.

    Raises:
        UnknownNameError: If there is no such kind.
    """
    if name not in SOURCES:
        raise UnknownNameError("source", name, SOURCES)
    read: Callable[[Path], list[Recording]] = importlib.import_module(SOURCES[name]).read
    return read


def write(
    recordings: Sequence[Recording],
    folder: Path,
    *,
    origin: str,
    overwrite: bool = False,
    on_episode: Callable[[int], None] = lambda done: None,
) -> Manifest:
    """Write demonstrations as a finished data set.

    Args:
        recordings: At least one.
        folder: Of the data set.
        origin: Where they come from, for the manifest.
        overwrite: Whether a data set that is there may be replaced.
        on_episode: Told the number of episodes written.

    Raises:
        DataError: If they are of several towns or cars, lie outside their town, or something is in the folder; then nothing is
            written.
    """
    require_writable(folder, overwrite=overwrite)
    first = recordings[0].episode
    town, car = town_of(first), car_of(first)
    for it in recordings:
        _require_drivable(it, first)
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{folder.name}.", dir=folder.parent) as place:
        made, entries = Path(place, "data"), []
        for index, it in enumerate(recordings):
            metadata = {**it.episode.metadata, IMPORTED: origin}
            content = store.to_bytes(dataclasses.replace(it.episode, metadata=metadata))
            file = f"{it.name}.hdf5"
            entries.append(dataset.describe(it.episode, name=it.name, file=file, content=content))
            made.mkdir(exist_ok=True)
            (made / file).write_bytes(content)
            on_episode(index + 1)
        manifest = Manifest(
            town=town.name,
            town_digest=town.digest,
            seed=first.seed,
            settings={IMPORTED: origin},
            versions=versions.versions(),
            num_planned=len(entries),
            episodes=tuple(entries),
            car=car.name,
            car_digest=car.digest,
        )
        dataset.write_manifest(manifest, made)
        if folder.exists():
            shutil.rmtree(folder)
        made.rename(folder)
    return manifest


def require_writable(folder: Path, *, overwrite: bool) -> None:
    """Refuse to write over anything but, if asked, a data set and nothing beside it.

    Raises:
        DataError: If something else is there.
    """
    if not folder.exists() or (folder.is_dir() and not any(folder.iterdir())):
        return
    if not overwrite:
        raise DataError(
            f"'{folder}' is there already. Give another --out, or replace it with --overwrite."
        )
    strangers = (
        set(folder.iterdir()) - set(dataset.files_of(folder)) if folder.is_dir() else {folder}
    )
    if strangers:
        raise DataError(
            f"'{min(strangers)}' belongs to no data set; --overwrite replaces data sets alone. Give another --out."
        )


def _require_drivable(recording: Recording, first: Episode) -> None:
    episode = recording.episode
    if episode.town != first.town:
        raise DataError(
            f"'{recording.name}' was driven in {episode.town}, others in {first.town}; expected one town. Import each by itself."
        )
    town = town_of(episode)
    car_of(episode)
    low, high = town.bounds[:2], town.bounds[2:]
    outside = np.any((episode.vehicle[:, :2] < low) | (episode.vehicle[:, :2] > high), axis=1)
    if np.all(outside):
        x, y = episode.vehicle[0, :2].tolist()
        raise DataError(
            f"'{recording.name}' begins at ({x:.1f}, {y:.1f}) m and never comes into {town.name}, which reaches from "
            f"({low[0]:.0f}, {low[1]:.0f}) to ({high[0]:.0f}, {high[1]:.0f}) m. Expected metres, x east and y north "
            f"(CARLA's y is south: turn its sign, and that of yaw)."
        )
