import itertools
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

from mjdrive.datatypes import Episode, Infraction, InfractionKind, Town
from mjdrive.evaluation import figures
from mjdrive.evaluation.figure_style import SYMBOLS

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
    figures.draw_trajectory(drive, crossing, tmp_path / "a.png")
    with matplotlib.rc_context({"font.size": 30, "lines.linewidth": 5, "axes.grid": True}):
        figures.draw_trajectory(drive, crossing, tmp_path / "b.png")
    assert read(tmp_path / "a.png") == read(tmp_path / "b.png")


def test_every_kind_of_infraction_has_a_symbol_of_its_own() -> None:
    assert SYMBOLS.keys() == set(InfractionKind)
    assert len({marker for _, marker, _ in SYMBOLS.values()}) == len(InfractionKind)


def test_every_kind_of_infraction_looks_different(
    crossing: Town, make_drive: Make, tmp_path: Path
) -> None:
    pictures = set()
    for infractions in ((), *((Infraction(kind, 3.0, 30.0, 0.0, ""),) for kind in InfractionKind)):
        drive = make_drive(np.linspace(0.0, 100.0, 201), infractions=infractions)
        figures.draw_trajectory(drive, crossing, tmp_path / "a.png")
        pictures.add(read(tmp_path / "a.png"))
    assert len(pictures) == 1 + len(InfractionKind)


def test_symbols_of_different_kinds_at_one_place_hide_none(
    crossing: Town, make_drive: Make
) -> None:
    one_place = tuple(Infraction(kind, 1.0, 50.0, 0.0, "") for kind in InfractionKind)
    axes = Figure().add_subplot()
    drive = make_drive(np.linspace(0.0, 100.0, 201), infractions=one_place)
    figures._draw_infractions(axes, drive, crossing)
    places = np.concatenate([symbol.get_offsets() for symbol in axes.collections])
    gaps = [np.hypot(*(a - b)) for a, b in itertools.combinations(places, 2)]
    assert len(gaps) == 15
    assert min(gaps) > 0.98 * figures.SYMBOL_SPACING * (100.0 + 2 * figures.MARGIN)
    assert places[0].tolist() == [50.0, 0.0]


@pytest.mark.parametrize("steps", [0, 1, 2])
def test_short_drives_can_be_drawn(
    crossing: Town, make_drive: Make, tmp_path: Path, steps: int
) -> None:
    drive = make_drive(np.arange(steps, dtype=float))
    figures.draw_trajectory(drive, crossing, tmp_path / "a.png")
    read(tmp_path / "a.png")


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


def test_a_picture_of_many_drives_shows_the_first_of_them(
    crossing: Town,
    make_drive: Callable[..., Episode],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(figures, "MOST_MAPS", 2)
    drives = {name: make_drive(np.linspace(0, 50, 51)) for name in ("one", "two", "three")}
    figures.draw_dataset(drives, crossing, tmp_path / "all.png")
    del drives["three"]
    figures.draw_dataset(drives, crossing, tmp_path / "two.png")
    assert (tmp_path / "all.png").read_bytes() == (tmp_path / "two.png").read_bytes()
