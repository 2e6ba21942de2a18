"""What is kept of a drive."""

import dataclasses

import pytest

from mjdrive.datatypes import Episode, Infraction, InfractionKind, Town
from mjdrive.study.records import drive_records


def test_a_path_ends_where_the_papers_figure_does_and_so_do_its_pins(
    town02: Town, short_drive: Episode, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drive_records, "PATH_STEPS", 10)
    assert len(short_drive.time) > 11
    infractions = (
        Infraction(InfractionKind.RED_LIGHT, 1.0, 1.0, 2.0, ""),
        Infraction(InfractionKind.RED_LIGHT, 1.1, 3.0, 4.0, ""),
        Infraction(InfractionKind.OFF_ROAD, 1.1, 5.0, 6.0, ""),
    )
    drive = dataclasses.replace(short_drive, infractions=infractions)
    found = drive_records.record(drive, town02, digest="", path_of=("a", 0))
    assert found.figures.steps == len(drive.time)
    assert found.figures.red_lights == 2
    assert found.path is not None
    assert found.path.duration_s == pytest.approx(1.0)
    assert found.path.points == tuple(
        (round(x, 2), round(y, 2)) for x, y in drive.vehicle[[0, 5], :2].tolist()
    )
    assert (found.path.red_lights, found.path.mishaps) == (((1.0, 2.0),), ())
