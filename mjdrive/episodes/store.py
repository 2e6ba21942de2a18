"""Episodes on disk: HDF5 in robomimic's layout, whole files only, the same bytes for the same episode.

    /            attributes  format, town, policy, seed, light_phase, metadata (JSON)
    /data        attribute   total (steps in the file)
    /data/demo_0 attribute   num_samples (the same number)
        actions              Episode.actions  (T, 2)
        states               Episode.physics  (T, S)
        dones                1 at the last step, else 0  (T,)
        labels               Episode.labels   (T, 2); a second name of `actions` where they are equal
        obs/vehicle          Episode.vehicle  (T, 6)
        obs/time             Episode.time     (T,)
        obs/on_lane          Episode.on_lane  (T,)
    /infractions             kind (K,), time (K,), position (K, 2), cause (K,)

The study has no reward, so there is none here; the bird's-eye view is recomputed from `obs/vehicle`. Each part
of the file carries a check sum, so a damaged file is refused instead of read.
"""

import hashlib
import io
import json
from pathlib import Path

import h5py
import numpy as np

from mjdrive.datatypes import Episode, Infraction, InfractionKind
from mjdrive.errors import DataError
from mjdrive.files import write_atomically

FORMAT = "mjdrive-episode-2"

_ARRAYS = {
    "actions": "actions",
    "states": "physics",
    "labels": "labels",
    "obs/vehicle": "vehicle",
    "obs/time": "time",
    "obs/on_lane": "on_lane",
}


def write(episode: Episode, path: Path) -> None:
    """Write one episode; an existing file of that name is replaced in one step.

    Args:
        episode: Drive to keep; equal episodes give equal bytes.
        path: File to write, by custom `*.hdf5`.
    """
    write_atomically(path, to_bytes(episode))


def read(path: Path) -> Episode:
    """Read one episode.

    Args:
        path: File that `write` made.

    Returns:
        The episode, equal to the one that was written.

    Raises:
        DataError: If the file is missing, truncated, damaged, or no episode of this format.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise DataError(
            f"Cannot read episode '{path}': {error.strerror}. Expected a file that "
            f"`mjdrive collect` or `mjdrive drive` wrote."
        ) from error
    return from_bytes(content, name=str(path))


def digest(content: bytes) -> str:
    """SHA-256 of the content of a file, hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def to_bytes(episode: Episode) -> bytes:
    """Turn an episode into the content of an HDF5 file, without time stamps."""
    # Version 1.10 of the file format puts check sums on structure, too; in memory, so that no half file is seen.
    with h5py.File(
        "episode", "w", driver="core", backing_store=False, libver=("v110", "v110")
    ) as file:
        file.attrs["format"] = np.bytes_(FORMAT)
        file.attrs["town"] = np.bytes_(episode.town.encode())
        file.attrs["policy"] = np.bytes_(episode.policy.encode())
        file.attrs["seed"] = np.int64(episode.seed)
        file.attrs["light_phase"] = np.float64(episode.light_phase)
        metadata = json.dumps(dict(episode.metadata), sort_keys=True)
        _put(file, "metadata", np.frombuffer(metadata.encode(), np.uint8))
        data = file.create_group("data")
        data.attrs["total"] = np.int64(len(episode.time))
        demo = data.create_group("demo_0")
        demo.attrs["num_samples"] = np.int64(len(episode.time))
        for name, field in _ARRAYS.items():
            if field == "labels" and _are_the_same(episode.labels, episode.actions):
                demo[name] = demo["actions"]
            else:
                _put(demo, name, getattr(episode, field))
        _put(demo, "dones", (np.arange(len(episode.time)) == len(episode.time) - 1).astype("u1"))
        _put_infractions(file.create_group("infractions"), episode.infractions)
        file.flush()
        return bytes(file.id.get_file_image())


def from_bytes(content: bytes, *, name: str) -> Episode:
    """Read the content of an episode file.

    Args:
        content: The whole file.
        name: What error messages call it.

    Raises:
        DataError: If the content is truncated, damaged, or no episode of this format.
    """
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            found = file.attrs.get("format", np.bytes_(b"none")).decode(errors="replace")
            if found != FORMAT:
                raise DataError(
                    f"'{name}' has episode format '{found}'; expected '{FORMAT}'. "
                    f"Drive or collect it again with this version of mjdrive."
                )
            return _episode(file)
    except (OSError, KeyError, ValueError, RuntimeError, TypeError, AttributeError) as error:
        raise DataError(
            f"'{name}' is no whole episode file ({len(content)} bytes; {error}). Expected an HDF5 file that "
            f"`mjdrive collect` or `mjdrive drive` wrote; delete it and make it again."
        ) from error


def _episode(file: h5py.File) -> Episode:
    """Build the episode from an open file; damage shows as one of the exceptions that `from_bytes` meets."""
    demo = file["data/demo_0"]
    arrays = {field: demo[name][()] for name, field in _ARRAYS.items()}
    lengths = {name: len(array) for name, array in arrays.items()}
    if set(lengths.values()) != {int(demo.attrs["num_samples"])}:
        raise ValueError(f"its arrays differ in length: {lengths}")
    return Episode(
        town=file.attrs["town"].decode(),
        policy=file.attrs["policy"].decode(),
        seed=int(file.attrs["seed"]),
        light_phase=float(file.attrs["light_phase"]),
        infractions=_infractions(file["infractions"]),
        metadata=json.loads(file["metadata"][()].tobytes()),
        **arrays,
    )


def _put(group: h5py.Group, name: str, array: np.ndarray) -> None:
    """Store one array with check sums; HDF5 cannot chunk, and so cannot check, an array without elements."""
    if array.size == 0:
        group.create_dataset(name, data=array)
        return
    # Column by column: one quantity after the other packs to five sixths of all of them by turns, and in less time.
    group.create_dataset(
        name,
        data=array,
        chunks=(len(array), *(1 for _ in array.shape[1:])),
        compression="gzip",
        compression_opts=9,
        shuffle=True,
        fletcher32=True,
    )


def _are_the_same(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two arrays are equal bit by bit."""
    return (one.dtype, one.shape, one.tobytes()) == (other.dtype, other.shape, other.tobytes())


def _put_infractions(group: h5py.Group, infractions: tuple[Infraction, ...]) -> None:
    """Store the infractions as parallel arrays; names as UTF-8, padded to the longest."""
    causes = [infraction.cause.encode() for infraction in infractions]
    longest = max([len(text) for text in causes], default=1)
    _put(group, "kind", np.array([infraction.kind for infraction in infractions], np.uint8))
    _put(group, "time", np.array([infraction.time for infraction in infractions], np.float64))
    position = [(infraction.x, infraction.y) for infraction in infractions]
    _put(group, "position", np.array(position, np.float64).reshape(-1, 2))
    _put(group, "cause", np.array(causes, f"S{max(longest, 1)}"))


def _infractions(group: h5py.Group) -> tuple[Infraction, ...]:
    """Read what `_put_infractions` stored."""
    columns = (group[name][()].tolist() for name in ("kind", "time", "position", "cause"))
    return tuple(
        Infraction(kind=InfractionKind(kind), time=time, x=x, y=y, cause=text.decode())
        for kind, time, (x, y), text in zip(*columns, strict=True)
    )
