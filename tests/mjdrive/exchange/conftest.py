"""One drive with an infraction, exported once to each format and read back by that format's own reader."""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest

from mjdrive.datatypes import Episode, Infraction, InfractionKind
from mjdrive.exchange import formats
from mjdrive.exchange.sources import Recording


@pytest.fixture(scope="session")
def breach(short_drive: Episode) -> Infraction:
    x, y = short_drive.vehicle[5, :2].tolist()
    return Infraction(InfractionKind.COLLISION, 0.5, x, y, "</script> & <b>pole</b>")


@pytest.fixture(scope="session")
def recordings(short_drive: Episode, breach: Infraction) -> list[Recording]:
    return [
        Recording("bad", dataclasses.replace(short_drive, infractions=(breach,))),
        Recording("good", short_drive),
    ]


@pytest.fixture(scope="session")
def exported(
    recordings: list[Recording], tmp_path_factory: pytest.TempPathFactory
) -> Callable[[str], Path]:
    """Folder of an export to a format."""
    made: dict[str, Path] = {}

    def export(name: str) -> Path:
        if name not in made:
            made[name] = tmp_path_factory.mktemp("exports") / name
            formats.export(recordings, formats.known(name), made[name])
        return made[name]

    return export
