"""Formats that drives are exported to, and how an export is written: whole, and over nothing that is there."""

import importlib
import importlib.util
import json
import shutil
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from mjdrive import versions
from mjdrive.errors import DataError, MissingPackageError, UnknownNameError
from mjdrive.exchange.sources import Recording

MARK = "mjdrive.json"
"""File in the folder of every export: what it was made from. Folders without it are never overwritten."""

Told = Callable[[int], None]
"""Told the number of control steps done."""


class Format(NamedTuple):
    """How drives look to somebody else's tools.

    Attributes:
        name: As in `--to`.
        module: Has `write`: one recording into a file for formats with a suffix, all into a folder for others.
        suffix: Of a file, which holds one drive; empty if a folder holds all.
        package: Module that it needs; empty for what mjdrive has anyway.
        install: What pip calls that.
    """

    name: str
    module: str
    suffix: str = ""
    package: str = ""
    install: str = ""


FORMATS = {
    it.name: it
    for it in (
        Format("html", "mjdrive.exchange.html.export", ".html"),
        Format("minari", "mjdrive.exchange.minari"),
        Format("lerobot", "mjdrive.exchange.lerobot", package="pyarrow", install="pyarrow"),
        Format("mcap", "mjdrive.exchange.mcap", ".mcap", package="mcap", install="mcap"),
        Format("rerun", "mjdrive.exchange.rerun", ".rrd", package="rerun", install="rerun-sdk"),
    )
}


def known(name: str) -> Format:
    """Find a format by its name, and make sure that what it needs is installed.

    Raises:
        UnknownNameError: If there is no such format.
        MissingPackageError: If its package is not installed.
    """
    if name not in FORMATS:
        raise UnknownNameError("format", name, FORMATS)
    found = FORMATS[name]
    if found.package and importlib.util.find_spec(found.package) is None:
        raise MissingPackageError(
            found.install, wanted_for=f"`mjdrive export --to {name}`", extra="export"
        )
    return found


def export(
    recordings: Sequence[Recording],
    to: Format,
    out: Path,
    *,
    overwrite: bool = False,
    on_step: Told = lambda done: None,
) -> tuple[Path, ...]:
    """Write drives in a format.

    Args:
        recordings: At least one.
        to: The format.
        out: For a format with files: a file that ends in its suffix, of one drive, or else a folder. For one with folders: the folder.
        overwrite: Whether an earlier export may be replaced.
        on_step: Told the number of control steps done, of all drives.

    Returns:
        What was written: the files, or the folder.

    Raises:
        DataError: If something is there already, or the drives do not go together; then nothing is written.
    """
    assert recordings, "an export needs a drive"
    require_writable(len(recordings), to, out, overwrite=overwrite)
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{out.name}.", dir=out.parent) as place:
        folder = Path(place, "export")
        folder.mkdir()
        write = importlib.import_module(to.module).write
        if not to.suffix:
            write(recordings, folder, on_step=on_step)
        else:
            _write_files(write, recordings, folder, to, on_step)
        if to.suffix and out.suffix == to.suffix:
            (folder / f"{recordings[0].name}{to.suffix}").replace(out)
            return (out,)
        (folder / MARK).write_text(_mark(recordings, to))
        if out.exists():
            shutil.rmtree(out)
        folder.rename(out)
    if not to.suffix:
        return (out,)
    return tuple(out / f"{it.name}{to.suffix}" for it in recordings)


def require_writable(count: int, to: Format, out: Path, *, overwrite: bool) -> None:
    """Refuse to write over what is there, or several drives into one file.

    Args:
        count: How many drives [-].
        to: The format.
        out: Where.
        overwrite: Whether an earlier export may be replaced.

    Raises:
        DataError: If so.
    """
    is_file = bool(to.suffix) and out.suffix == to.suffix
    if is_file and count > 1:
        raise DataError(
            f"{count} drives do not fit into the one file '{out}'. Expected a folder for them: give --out without {to.suffix}."
        )
    if not out.exists() or (out.is_dir() and not is_file and not any(out.iterdir())):
        return
    if not overwrite:
        raise DataError(
            f"'{out}' is there already. Give another --out, or replace it with --overwrite."
        )
    if out.is_dir() and (is_file or not (out / MARK).is_file()):
        raise DataError(
            f"'{out}' is a folder that no export made (it has no {MARK}); --overwrite replaces exports alone. Give another --out."
        )
    if out.is_file() and not is_file:
        raise DataError(f"'{out}' is a file; expected a folder for {to.name}. Give another --out.")


def _write_files(
    write: Callable[..., None],
    recordings: Sequence[Recording],
    folder: Path,
    to: Format,
    on_step: Told,
) -> None:
    before = 0
    for it in recordings:
        write(
            it,
            folder / f"{it.name}{to.suffix}",
            on_step=lambda done, base=before: on_step(base + done),
        )
        before += len(it.episode.time)


def _mark(recordings: Sequence[Recording], to: Format) -> str:
    made_from = {
        "format": to.name,
        "versions": versions.versions(),
        "episodes": [
            {
                "name": it.name,
                "town": it.episode.town,
                "policy": it.episode.policy,
                "seed": it.episode.seed,
                "steps": len(it.episode.time),
                "metadata": dict(it.episode.metadata),
            }
            for it in recordings
        ],
    }
    return json.dumps(made_from, indent=2, sort_keys=True) + "\n"
