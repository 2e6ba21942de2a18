"""`mjdrive drive --episodes N` here, in two processes and on a cluster."""

import hashlib
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.episodes.plan import episode_seed

WORDS = ("drive", "--town", "town02", "--policy", "pid", "--steps", "12", "--seed", "4")


def run(*words: str) -> str:
    result = CliRunner().invoke(main, [*WORDS, *words], catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    return result.stdout


def digests(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.mark.slow
def test_two_processes_and_a_second_start_give_the_bytes_of_one_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shown = run("--episodes", "3", "--out", "one")
    assert "distance [m]" in shown
    assert "clean drives" in shown
    run("--episodes", "2", "--jobs", "2", "--out", "two")
    run("--episodes", "3", "--jobs", "2", "--out", "two")
    assert digests(tmp_path / "one") == digests(tmp_path / "two")
    names = {path.name for path in (tmp_path / "one").iterdir()}
    assert names == {
        "drives.json",
        "episode-000",
        "episode-001",
        "episode-002",
        "spread.png",
        "summary.json",
        "trajectories.png",
    }
    summary = json.loads((tmp_path / "one/summary.json").read_text())
    assert (summary["episodes"], summary["steps"]) == (3, 36)
    assert summary["seeds"] == [episode_seed(4, index) for index in range(3)]
    refused = CliRunner().invoke(main, [*WORDS, "--episodes", "3", "--out", "one", "--seed", "5"])
    assert (refused.exit_code, "they differ in seed." in refused.stderr) == (2, True)


@pytest.mark.slow
def test_a_ray_cluster_gives_the_bytes_of_one_run(
    ray_address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    run("--episodes", "2", "--out", "one")
    shown = run("--episodes", "2", "--backend", "ray", "--address", ray_address, "--out", "cluster")
    assert "clean drives" in shown
    assert digests(tmp_path / "cluster") == digests(tmp_path / "one")
    assert {"episode-000/episode.hdf5", "episode-001/summary.json"} < digests(
        tmp_path / "one"
    ).keys()
