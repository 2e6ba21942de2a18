"""Many drives: kept one by one, gone on with, never mixed with others."""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mjdrive import versions
from mjdrive.datatypes import Episode, Town
from mjdrive.errors import DataError, WorkerError
from mjdrive.evaluation import drives
from mjdrive.evaluation.drives import Driving, PlannedDrive, make_drives, plan_drives
from mjdrive.evaluation.metrics import DriveSummary
from mjdrive.execution.serial import SerialExecutor
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle import cars

STEPS = 6
SAME = {"town": "crossing", "policy": "glider"}


class Glider:
    """Goes as far as its seed says, and counts its drives."""

    def __init__(self, make_drive: Callable[..., Episode]) -> None:
        self._make_drive = make_drive
        self.driven: list[int] = []

    def drive(self, simulation: object, *, seed: int, num_steps: int, **told: Any) -> Episode:
        self.driven.append(seed)
        told["on_step"](num_steps)
        told["on_late_plans"](1)
        return self._make_drive(np.linspace(0, 10 + seed % 50, num_steps))


@pytest.fixture
def glider(
    make_drive: Callable[..., Episode], simulation: Simulation, monkeypatch: pytest.MonkeyPatch
) -> Glider:
    """It needs no simulation, any that is there will do; and its town lies in no folder."""
    monkeypatch.setattr(drives, "Simulation", lambda town, *, car: simulation)
    monkeypatch.setattr(library, "require_same", lambda town: None)
    return Glider(make_drive)


def make(
    glider: Glider,
    town: Town,
    folder: Path,
    planned: tuple[PlannedDrive, ...],
    *,
    description: dict[str, str] = SAME,
    **told: Any,
) -> list[DriveSummary]:
    work = Driving(glider, town, cars.load(), STEPS, versions.all_versions())
    return make_drives(
        work, planned, folder, description=description, executor=SerialExecutor(), **told
    )


def digests(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_fewer_drives_are_the_first_of_more_and_no_two_are_alike() -> None:
    more = plan_drives(20, seed=3)
    assert plan_drives(5, seed=3) == more[:5]
    assert len({drive.seed for drive in (*more, *plan_drives(20, seed=4))}) == 40
    assert [drive.name for drive in more[:2]] == ["episode-000", "episode-001"]


def test_each_drive_has_a_folder_and_is_told(
    crossing: Town, glider: Glider, tmp_path: Path
) -> None:
    told: list[tuple[str, int, int]] = []
    late: list[int] = []
    found = make(
        glider,
        crossing,
        tmp_path / "drives",
        plan_drives(2, seed=0),
        report_progress=lambda *words: told.append(words),
        on_late_plans=late.append,
    )
    assert {path.name for path in (tmp_path / "drives/episode-001").iterdir()} == {
        "episode.hdf5",
        "trajectory.png",
        "actions.png",
        "summary.json",
    }
    assert [drive.steps for drive in found] == [STEPS, STEPS]
    assert [words for words in told if words[1] == words[2]] == [
        ("episode-000", STEPS, STEPS),
        ("episode-001", STEPS, STEPS),
    ]
    assert late == [1, 1]


def test_what_is_missing_or_was_cut_short_is_driven_and_nothing_else(
    crossing: Town, glider: Glider, tmp_path: Path
) -> None:
    planned = plan_drives(4, seed=0)
    whole = make(glider, crossing, tmp_path / "whole", planned)
    make(glider, crossing, tmp_path / "part", planned[:3])
    (tmp_path / "part/episode-001/summary.json").unlink()
    (tmp_path / "part/episode-002/summary.json").write_text("{")
    glider.driven.clear()
    assert make(glider, crossing, tmp_path / "part", planned) == whole
    assert glider.driven == [drive.seed for drive in planned[1:]]
    assert digests(tmp_path / "part") == digests(tmp_path / "whole")


def test_the_figures_are_written_last(
    crossing: Town, glider: Glider, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write, written = drives.write_atomically, []

    def note(path: Path, content: bytes) -> None:
        written.append(path.name)
        write(path, content)

    monkeypatch.setattr(drives, "write_atomically", note)
    make(glider, crossing, tmp_path / "drives", plan_drives(1, seed=0))
    assert (written[0], written[-1]) == ("drives.json", "summary.json")


def test_other_drives_and_strangers_are_refused_by_what_differs(
    crossing: Town, glider: Glider, tmp_path: Path
) -> None:
    make(glider, crossing, tmp_path / "drives", plan_drives(1, seed=0))
    before = digests(tmp_path)
    other = SAME | {"policy": "sledge"}
    with pytest.raises(DataError, match=r"they differ in policy\."):
        make(glider, crossing, tmp_path / "drives", plan_drives(1, seed=0), description=other)
    (tmp_path / "drives/drives.json").write_text("no JSON")
    with pytest.raises(DataError, match="they differ in policy, town"):
        make(glider, crossing, tmp_path / "drives", plan_drives(1, seed=0))
    (tmp_path / "drives/drives.json").write_text(json.dumps(SAME, indent=2) + "\n")
    with pytest.raises(DataError, match="is there already"):
        make(glider, crossing, tmp_path / "drives/episode-000", plan_drives(1, seed=0))
    assert set(digests(tmp_path)) == set(before)


def test_a_machine_of_other_versions_does_not_drive(crossing: Town, glider: Glider) -> None:
    wanted = versions.all_versions() | {"mujoco": "1.50"}
    work = Driving(glider, crossing, cars.load(), STEPS, wanted)
    with pytest.raises(WorkerError, match=r"has mujoco 3.*; expected mujoco 1\.50"):
        work.begin()
    assert glider.driven == []


def test_a_drive_that_lost_a_file_or_holds_a_damaged_one_is_mended_by_running_again(
    crossing: Town, glider: Glider, tmp_path: Path
) -> None:
    planned = plan_drives(1, seed=0)
    make(glider, crossing, tmp_path, planned)
    before = digests(tmp_path)
    for name in ("episode.hdf5", "trajectory.png", "actions.png"):
        (tmp_path / "episode-000" / name).unlink()
        make(glider, crossing, tmp_path, planned)
        assert digests(tmp_path) == before
    episode = tmp_path / "episode-000/episode.hdf5"
    episode.write_bytes(episode.read_bytes()[:-100])
    make(glider, crossing, tmp_path, planned)
    assert digests(tmp_path) == before


def test_nothing_is_set_up_where_no_drive_is_missing(
    crossing: Town, glider: Glider, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    planned = plan_drives(1, seed=0)
    whole = make(glider, crossing, tmp_path, planned)
    monkeypatch.delattr(drives, "Simulation")
    assert make(glider, crossing, tmp_path, planned) == whole


def test_a_machine_with_another_car_does_not_drive(
    crossing: Town, glider: Glider, tmp_path: Path
) -> None:
    car = tmp_path / "car.xml"
    car.write_bytes(cars.load().path.read_bytes())
    work = Driving(glider, crossing, cars.load(car), STEPS, versions.all_versions())
    work.begin()
    car.write_text(car.read_text() + "<!-- heavier -->")
    with pytest.raises(WorkerError, match=r"the car '.*car\.xml' is .*at the same place"):
        work.begin()
