from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np
import pytest

from mjdrive.datatypes import Episode, Infraction, InfractionKind, Town
from mjdrive.evaluation import timelines

Make = Callable[..., Episode]


def draw(drive: Episode, town: Town, path: Path) -> bytes:
    timelines.draw_actions(drive, town, path)
    content = path.read_bytes()
    assert content.startswith(b"\x89PNG")
    assert b"matplotlib" not in content
    return content


def test_picture_does_not_depend_on_the_users_style(
    crossing: Town, make_drive: Make, tmp_path: Path
) -> None:
    drive = make_drive(np.linspace(0.0, 100.0, 201))
    plain = draw(drive, crossing, tmp_path / "a.png")
    with matplotlib.rc_context({"font.size": 30, "lines.linewidth": 5, "axes.grid": True}):
        assert draw(drive, crossing, tmp_path / "b.png") == plain


def test_every_kind_of_infraction_looks_different(
    crossing: Town, make_drive: Make, tmp_path: Path
) -> None:
    drives = [
        make_drive(np.linspace(0.0, 100.0, 201), infractions=infractions)
        for infractions in (
            (),
            *((Infraction(kind, 3.0, 30.0, 0.0, ""),) for kind in InfractionKind),
        )
    ]
    pictures = {draw(drive, crossing, tmp_path / "a.png") for drive in drives}
    assert len(pictures) == 1 + len(InfractionKind)


def test_waiting_is_shaded(crossing: Town, make_drive: Make, tmp_path: Path) -> None:
    red = draw(make_drive(np.full(50, 36.0), light_phase=15.0), crossing, tmp_path / "red.png")
    green = draw(make_drive(np.full(50, 36.0), light_phase=0.0), crossing, tmp_path / "green.png")
    assert red != green


def test_keeping_left_in_the_lane_shows(crossing: Town, make_drive: Make, tmp_path: Path) -> None:
    x = np.linspace(0.0, 39.0, 101)
    left, right = (make_drive(x, y=np.full(101, y)) for y in (0.5, -0.5))
    assert draw(left, crossing, tmp_path / "a.png") != draw(right, crossing, tmp_path / "b.png")


@pytest.mark.parametrize("steps", [0, 1, 2])
def test_short_drives_can_be_drawn(
    crossing: Town, make_drive: Make, tmp_path: Path, steps: int
) -> None:
    draw(make_drive(np.arange(steps, dtype=float)), crossing, tmp_path / "a.png")
