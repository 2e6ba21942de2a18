import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np
import pytest

from mjdrive.datatypes import Episode, Infraction, InfractionKind, Town
from mjdrive.evaluation import figures

Make = Callable[..., Episode]


@pytest.fixture
def drive(make_drive: Make) -> Episode:
    infractions = tuple(
        Infraction(kind, kind + 1.0, 10.0 * kind, 0.0, "") for kind in InfractionKind
    )
    return make_drive(np.linspace(0.0, 100.0, 201), infractions=infractions)


def read(path: Path) -> bytes:
    content = path.read_bytes()
    assert content.startswith(b"\x89PNG")
    assert b"matplotlib" not in content
    return content


def test_same_drive_gives_the_same_picture(crossing: Town, drive: Episode, tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        figures.draw_trajectory(drive, crossing, tmp_path / name)
    assert read(tmp_path / "a.png") == read(tmp_path / "b.png")


def test_picture_does_not_depend_on_the_users_style(
    crossing: Town, drive: Episode, tmp_path: Path
) -> None:
    figures.draw_actions(drive, crossing, tmp_path / "a.png")
    with matplotlib.rc_context({"font.size": 30, "lines.linewidth": 5, "axes.grid": True}):
        figures.draw_actions(drive, crossing, tmp_path / "b.png")
    assert read(tmp_path / "a.png") == read(tmp_path / "b.png")


def test_infractions_change_the_picture(
    crossing: Town, drive: Episode, make_drive: Make, tmp_path: Path
) -> None:
    clean = make_drive(np.linspace(0.0, 100.0, 201))
    for draw in (figures.draw_trajectory, figures.draw_actions):
        draw(drive, crossing, tmp_path / "a.png")
        draw(clean, crossing, tmp_path / "b.png")
        assert read(tmp_path / "a.png") != read(tmp_path / "b.png")


def test_waiting_is_shaded(crossing: Town, make_drive: Make, tmp_path: Path) -> None:
    for name, phase in (("red.png", 15.0), ("green.png", 0.0)):
        waiting = make_drive(np.full(50, 36.0), light_phase=phase)
        figures.draw_actions(waiting, crossing, tmp_path / name)
    assert read(tmp_path / "red.png") != read(tmp_path / "green.png")


@pytest.mark.parametrize("steps", [0, 1, 2])
def test_short_drives_can_be_drawn(
    crossing: Town, make_drive: Make, tmp_path: Path, steps: int
) -> None:
    drive = make_drive(np.arange(steps, dtype=float))
    figures.draw_trajectory(drive, crossing, tmp_path / "a.png")
    figures.draw_actions(drive, crossing, tmp_path / "b.png")
    read(tmp_path / "a.png")
    read(tmp_path / "b.png")


def test_dataset_draws_every_episode(crossing: Town, drive: Episode, tmp_path: Path) -> None:
    figures.draw_dataset({f"route {i}": drive for i in range(7)}, crossing, tmp_path / "a.png")
    figures.draw_dataset({f"route {i}": drive for i in range(6)}, crossing, tmp_path / "b.png")
    assert read(tmp_path / "a.png") != read(tmp_path / "b.png")


def test_pyplot_is_not_touched() -> None:
    program = "import sys, mjdrive.evaluation.figures; print('matplotlib.pyplot' in sys.modules)"
    other = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert other.stdout == "False\n"
