import sys
from pathlib import Path

import pytest

from mjdrive.benchmarks import rivals
from mjdrive.benchmarks.comparison import NotMeasured, Plan
from mjdrive.benchmarks.rival_process import serve
from mjdrive.errors import WorkerError

COUNTING = """
class World:
    facts = {"versions": {"counting": argument_seen}, "observation": [1]}
    num_resets = 0
    deciding = 0.0
    def step(self):
        World.num_resets += 1
        print("rivals print whatever they like")
"""


def world_file(folder: Path, body: str) -> Path:
    path = folder / "world.py"
    path.write_text(
        f"def make(argument_seen):\n    import textwrap\n    names = {{'argument_seen': argument_seen}}\n"
        f"    exec({body!r}, names)\n    return names['World']()\n"
    )
    return path


def test_world_in_a_process_of_its_own_says_what_it_is_and_steps(tmp_path: Path) -> None:
    world = world_file(tmp_path, COUNTING)
    with serve("counting", Path(sys.executable), world, "7", log=tmp_path / "log") as served:
        assert served.facts["versions"] == {"counting": "7"}
        assert served.steps(10) >= 0.0
        assert served.steps(10) >= 0.0
    assert (tmp_path / "log").read_text().count("whatever") == 20


def test_world_that_fails_is_told_with_its_last_words(tmp_path: Path) -> None:
    world = world_file(tmp_path, "raise ValueError('no assets')")
    with (
        pytest.raises(WorkerError, match=r"sad ended \(ValueError: no assets\)"),
        serve("sad", Path(sys.executable), world, "-", log=tmp_path / "log"),
    ):
        pass


def test_world_that_dies_between_steps_is_told(tmp_path: Path) -> None:
    dying = COUNTING.replace("World.num_resets += 1", "raise SystemExit('gone')")
    world = world_file(tmp_path, dying)
    with (
        serve("dying", Path(sys.executable), world, "-", log=tmp_path / "log") as served,
        pytest.raises(WorkerError, match=r"dying ended \(gone\)"),
    ):
        served.steps(1)


@pytest.mark.parametrize("measure", [rivals.metadrive_84, rivals.car_racing, rivals.intersection])
def test_rival_without_environment_is_a_row_with_the_command_that_makes_it(
    measure, tmp_path: Path
) -> None:
    (row,) = measure(Plan(tmp_path, rivals=tmp_path / "nowhere"))
    assert isinstance(row, NotMeasured)
    assert "nowhere" in row.reason
    assert row.command == "python scripts/bench/install_rivals.py"


def test_installed_package_says_that_rivals_need_a_checkout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rivals, "WORLDS", tmp_path / "not in a wheel")
    (row,) = rivals.metadrive_192(Plan(tmp_path))
    assert isinstance(row, NotMeasured)
    assert "checkout" in row.reason


def test_every_rival_has_a_world_and_pinned_versions() -> None:
    for name in ("metadrive", "highway", "car_racing"):
        assert (rivals.WORLDS / f"{name}.py").is_file()
        pins = (rivals.WORLDS / f"{name}.txt").read_text().splitlines()
        assert all("==" in pin for pin in pins if not pin.startswith("#"))


def test_interpreter_that_is_gone_is_told(tmp_path: Path) -> None:
    world = world_file(tmp_path, COUNTING)
    with (
        pytest.raises(WorkerError, match=r"gone does not start.*install_rivals\.py again"),
        serve("gone", tmp_path / "python", world, "-", log=tmp_path / "log"),
    ):
        pass


def test_world_that_says_no_json_is_told(tmp_path: Path) -> None:
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho 'usage: python'\n")
    python.chmod(0o755)
    with (
        pytest.raises(WorkerError, match=r"odd said 'usage: python'\. Expected a line of JSON"),
        serve("odd", python, tmp_path, "-", log=tmp_path / "log"),
    ):
        pass


def test_time_of_deciding_does_not_count(tmp_path: Path) -> None:
    deciding = COUNTING.replace(
        "World.num_resets += 1", "import time; time.sleep(0.01); World.deciding += 1.0"
    )
    world = world_file(tmp_path, deciding)
    with serve("slow", Path(sys.executable), world, "7", log=tmp_path / "log") as served:
        assert -3.0 <= served.steps(3) < -2.5
