"""What `mjdrive collect` says, and what Ctrl-C leaves when several processes drive."""

import dataclasses
import hashlib
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mjdrive.cli import collected
from mjdrive.cli.main import main
from mjdrive.config import CollectConfig, DisturbanceConfig
from mjdrive.datatypes import Episode, Town
from mjdrive.episodes import dataset
from mjdrive.episodes.demonstrations import described
from mjdrive.episodes.manifest import Collection, EpisodeEntry, Manifest
from mjdrive.town import library, routing

WALK = ("--town", "town02", "--random-walk", "0.24", "--episodes", "4", "--noise", "0")
PAPER = CollectConfig(disturbance=None)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--jobs", "0"], "'--jobs'.*0 is too small; expected at least 1, or auto"),
        (["--jobs", "many"], "'--jobs'.*'many' is no number; expected.*auto"),
        (["--episodes", "0"], "'--episodes'.*x>=1"),
        (["--noise", "loud"], "'--noise'.*'loud'"),
    ],
)
def test_values_that_are_no_numbers_or_too_small_are_refused(
    words: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(main, ["collect", "--town", "town02", *words])
    assert result.exit_code == 2
    assert re.search(message, " ".join(result.stderr.split()))
    assert list(tmp_path.iterdir()) == []


def digests(folder: Path) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}


def start(*words: str, cwd: Path) -> subprocess.Popen[str]:
    """The command as a user starts it: with its processes in a group of their own, as a terminal does."""
    program = "from mjdrive.cli.main import main\nif __name__ == '__main__':\n    main()\n"
    (cwd / "run.py").write_text(program)
    return subprocess.Popen(
        [sys.executable, "run.py", "collect", *words],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def is_gone(group: int) -> bool:
    """Whether nobody is left of a group of processes; multiprocessing's own helper takes a moment to see it."""
    for _ in range(200):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.05)
    return False


def test_ctrl_c_leaves_whole_files_no_processes_and_a_collection_that_goes_on(
    tmp_path: Path,
) -> None:
    collecting = start(*WALK, "--out", "part", "--jobs", "2", cwd=tmp_path)
    deadline = time.monotonic() + 200.0
    while not list(tmp_path.glob("part/*.hdf5")):
        assert collecting.poll() is None, collecting.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.05)
    os.killpg(collecting.pid, signal.SIGINT)  # what a terminal sends to everyone in the foreground
    _, complaint = collecting.communicate(timeout=60.0)
    assert collecting.returncode == 130
    assert "Interrupted" in complaint
    assert "Traceback" not in complaint
    assert is_gone(collecting.pid)
    kept = digests(tmp_path / "part")
    assert 2 <= len(kept) <= 5
    assert not [name for name in kept if name.endswith("tmp")]

    words = ["collect", *WALK, "--out"]
    assert CliRunner().invoke(main, [*words, str(tmp_path / "part")]).exit_code == 0
    assert CliRunner().invoke(main, [*words, str(tmp_path / "whole")]).exit_code == 0
    whole = digests(tmp_path / "whole")
    assert digests(tmp_path / "part") == whole
    assert {name: digest for name, digest in kept.items() if name != "manifest.json"}.items() <= (
        whole.items()
    )


def test_sigterm_leaves_whole_files_no_processes_and_nothing_temporary(tmp_path: Path) -> None:
    collecting = start(*WALK, "--out", "part", "--jobs", "2", cwd=tmp_path)
    deadline = time.monotonic() + 200.0
    while not list(tmp_path.glob("part/*.hdf5")):
        assert collecting.poll() is None, collecting.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.05)
    collecting.terminate()
    _, complaint = collecting.communicate(timeout=60.0)
    assert collecting.returncode == 143
    assert "Traceback" not in complaint
    assert is_gone(collecting.pid)
    assert not list(tmp_path.glob("part/.*"))


def manifest(
    town: Town, settings: CollectConfig, *, names: tuple[str, ...], car: str = "default"
) -> Manifest:
    entries = tuple(
        EpisodeEntry(name, f"{name}.hdf5", "0" * 64, 2129, {}, deviations=4, recovered=3)
        for name in names
    )
    first = Collection(
        seed=0,
        settings=described(settings),
        versions={},
        car=car,
        car_digest="",
        num_planned=len(names),
    )
    return Manifest(
        town=town.name, town_digest=town.digest, episodes=entries, **dataclasses.asdict(first)
    )


TEN = tuple(f"route{number}-0" for number in range(10))


def test_papers_own_experiment_is_compared_sample_by_sample(town01: Town) -> None:
    rows = collected.rows(manifest(town01, PAPER, names=TEN), [], town01)
    assert rows["samples"] == "21,290 (2,129 s at 10 Hz)"
    assert rows["the paper's"] == (
        "21,287 samples; 12 left, 21 right, 14 straight "
        "(here +0.0 % samples; 2,129 s are within 2,100 ± 170 s)"
    )
    assert rows["recovered"] == "none: nothing was disturbed"


@pytest.mark.slow
@pytest.mark.timeout(900)  # 22,000 steps of physics
def test_papers_own_experiment_takes_as_long_and_turns_as_often(tmp_path: Path) -> None:
    collecting = start("--town", "town01", "--preset", "paper", "--out", "paper", cwd=tmp_path)
    said, complaint = collecting.communicate()
    assert collecting.returncode == 0, complaint
    steps = sum(entry.steps for entry in dataset.read_manifest(tmp_path / "paper").episodes)
    assert abs(0.1 * steps - collected.LAP) <= collected.LAP_MARGIN
    words = " ".join(said.replace("│", " ").split())
    assert "turns 12 left, 21 right, 14 straight" in words
    assert "within 2,100 ± 170 s" in words
    assert "not within" not in words


def test_lap_that_takes_too_long_is_said_to(town01: Town) -> None:
    ten = manifest(town01, PAPER, names=TEN)
    slow = tuple(dataclasses.replace(entry, steps=2271) for entry in ten.episodes)
    rows = collected.rows(dataclasses.replace(ten, episodes=slow), [], town01)
    assert "2,271 s are not within 2,100 ± 170 s" in rows["the paper's"]


@pytest.mark.parametrize(
    ("deviations", "told"),
    [
        (4, "30 of 40 deviations after a push (75 %)"),
        (0, "0 of 0 deviations after a push"),
    ],
)
def test_recoveries_are_told_even_if_nothing_was_to_recover_from(
    deviations: int, told: str, town01: Town
) -> None:
    ten = manifest(town01, CollectConfig(), names=TEN)
    recovered = min(deviations, 3)
    entries = tuple(
        dataclasses.replace(entry, deviations=deviations, recovered=recovered)
        for entry in ten.episodes
    )
    rows = collected.rows(dataclasses.replace(ten, episodes=entries), [], town01)
    assert rows["recovered"] == told


@pytest.mark.parametrize(
    ("settings", "names", "car", "difference"),
    [
        (CollectConfig(disturbance=DisturbanceConfig()), TEN, "default", "disturbed"),
        (PAPER, TEN[:3], "default", "not each of the ten routes once"),
        (PAPER, ("route0-0",) * 10, "default", "not each of the ten routes once"),
        (dataclasses.replace(PAPER, random_walk_km=9.0), TEN, "default", "a random walk"),
        (dataclasses.replace(PAPER, expert="mpc"), TEN, "default", "another expert"),
        (PAPER, TEN, "mkz", "another car"),
    ],
)
def test_any_other_experiment_says_why_it_cannot_be_compared(
    town01: Town, settings: CollectConfig, names: tuple[str, ...], car: str, difference: str
) -> None:
    text = collected.rows(manifest(town01, settings, names=names, car=car), [], town01)
    assert f"(not to be compared: this is {difference}" in text["the paper's"]


def test_other_towns_and_mixtures_are_not_the_papers(town01: Town, town02: Town) -> None:
    other = collected.rows(manifest(town02, PAPER, names=TEN), [], town02)
    assert "another town, town02" in other["the paper's"]
    whole = manifest(town01, PAPER, names=TEN)
    mixed = collected.rows(dataclasses.replace(whole, added=whole.collections), [], town01)
    assert mixed["episodes"] == "10, of 2 collections"
    assert "a mix of collections" in mixed["the paper's"]


def test_turns_of_the_papers_routes_are_the_papers(town01: Town) -> None:
    waypoints = library.load_settings("town01").routes
    drives = [along(town01, np.array(places)) for places in waypoints.values()]
    rows = collected.rows(manifest(town01, PAPER, names=TEN), drives, town01)
    assert rows["turns"] == "12 left, 21 right, 14 straight"


def along(town: Town, waypoints: np.ndarray) -> Episode:
    """A drive exactly along a route, a metre a step."""
    route = routing.route_through(town, waypoints)
    steps = len(route.points)
    vehicle = np.zeros((steps, 6))
    vehicle[:, :2], vehicle[:, 2] = route.points, route.yaw
    return Episode(
        town=town.name,
        policy="pid",
        seed=0,
        light_phase=0.0,
        time=0.1 * np.arange(steps),
        physics=np.zeros((steps, 1)),
        vehicle=vehicle,
        actions=np.zeros((steps, 2)),
        labels=np.zeros((steps, 2)),
        on_lane=np.ones(steps, bool),
        infractions=(),
        metadata={},
    )
