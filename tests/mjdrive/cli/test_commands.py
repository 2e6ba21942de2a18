"""The three commands on a route of 40 m and a network of a few steps."""

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.datatypes import Town
from mjdrive.episodes import collector
from mjdrive.town import library, routing
from mjdrive.town.settings import TownSettings

TINY = ["--preset", "quick", "--set", "optimiser.epochs=1", "--set", "sampler.grid.points=5"]


def run(*words: str) -> str:
    result = CliRunner().invoke(main, list(words), catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    return result.stdout


def digests(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, town02: Town) -> Path:
    """An empty folder, in a world where town02 has two routes of 40 m."""
    rng = np.random.default_rng(0)
    routes = {}
    for name in ("first", "second"):
        lane, station = routing.random_start(town02, rng)
        route = routing.random_route(town02, lane=lane, station=station, length=40.0, rng=rng)
        routes[name] = tuple((float(x), float(y)) for x, y in route.points[[0, -1]])
    monkeypatch.setattr(library, "load_settings", lambda name: TownSettings(routes=routes))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_three_commands_feed_each_other(workplace: Path) -> None:
    shown = run("collect", "--town", "town02")
    assert "Next: mjdrive train da-ibc" in shown
    manifest = json.loads((workplace / "data/town02/manifest.json").read_text())
    assert [entry["name"] for entry in manifest["episodes"]] == ["first-0", "second-0"]
    assert run("train", "bc-beta", "--data", "data/town02", *TINY)
    assert (workplace / "runs/bc-beta/model.safetensors").is_file()
    shown = run("drive", "--town", "town02", "--steps", "20")
    (drive,) = (workplace / "drives").iterdir()
    assert {path.name for path in drive.iterdir()} == {
        "episode.hdf5",
        "summary.json",
        "trajectory.png",
        "actions.png",
    }
    summary = json.loads((drive / "summary.json").read_text())
    assert (summary["policy"], summary["town"], summary["steps"]) == ("bc-beta", "town02", 20)
    assert set(summary["versions"]) == {"mjdrive", "mujoco", "numpy", "python", "torch"}
    assert {path.name for path in workplace.iterdir()} == {"data", "runs", "drives"}


def test_same_seed_gives_the_same_bytes(workplace: Path) -> None:
    for folder in ("a", "b"):
        run("collect", "--town", "town02", "--seed", "5", "--out", f"data/{folder}")
        run("train", "ibc", "--data", f"data/{folder}", "--out", f"{folder}/ibc", *TINY)
        run(
            "drive",
            "--town",
            "town02",
            "--steps",
            "5",
            "--policy",
            f"{folder}/ibc",
            "--out",
            f"drives/{folder}",
        )
    for place in ("data/{}", "drives/{}"):
        assert digests(workplace / place.format("a")) == digests(workplace / place.format("b"))
    weights = [(workplace / folder / "ibc/model.safetensors").read_bytes() for folder in "ab"]
    assert weights[0] == weights[1]


def test_collect_goes_on_where_it_stopped(workplace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run("collect", "--town", "town02", "--out", "whole")
    drive = collector.collect_route
    calls = []

    def interrupted(*args: object, **kwargs: object) -> object:
        calls.append(1)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return drive(*args, **kwargs)

    monkeypatch.setattr(collector, "collect_route", interrupted)
    words = ["collect", "--town", "town02", "--out", "part"]
    assert CliRunner().invoke(main, words).exit_code == 130
    assert set(digests(workplace / "part")) == {"manifest.json", "first-0.hdf5"}
    refused = CliRunner().invoke(main, ["train", "ibc", "--data", "part"])
    assert (refused.exit_code, "has 1 of 2 episodes" in refused.stderr) == (2, True)
    run(*words)
    assert len(calls) == 3  # the first episode was kept
    assert digests(workplace / "part") == digests(workplace / "whole")


def test_collect_refuses_another_data_set_unless_told(workplace: Path) -> None:
    run("collect", "--town", "town02")
    before = digests(workplace)
    refused = CliRunner().invoke(main, ["collect", "--town", "town02", "--noise", "0"])
    assert (refused.exit_code, "differs in settings" in refused.stderr) == (2, True)
    assert digests(workplace) == before
    run("collect", "--town", "town02", "--noise", "0", "--overwrite")
    assert digests(workplace) != before


def test_nothing_is_overwritten_unless_told(workplace: Path) -> None:
    run("collect", "--town", "town02", "--out", "data")
    run("train", "ibc", "--data", "data", *TINY)
    run("drive", "--town", "town02", "--steps", "2", "--policy", "pid", "--out", "drive")
    before = digests(workplace)
    for words, message in (
        (["train", "ibc", "--data", "data", *TINY], "holds a training run already"),
        (
            ["train", "ibc", "--data", "data", "--overwrite", "--set", "negatives.count=0"],
            "count is 0; expected",
        ),
        (["train", "ibc", "--data", "nowhere", "--overwrite"], "does not exist"),
        (["train", "ibc", "--data", "data", "--resume", "--seed", "8", *TINY], "seed"),
        (["drive", "--town", "town02", "--policy", "pid", "--out", "drive"], "is there already"),
    ):
        refused = CliRunner().invoke(main, words)
        assert refused.exit_code == 2, words
        assert message in refused.stderr
        assert digests(workplace) == before, words
    run("train", "ibc", "--data", "data", "--overwrite", "--seed", "8", *TINY)
    assert digests(workplace) != before


def test_truncated_episode_is_named(workplace: Path) -> None:
    run("collect", "--town", "town02", "--out", "data")
    path = workplace / "data/second-0.hdf5"
    path.write_bytes(path.read_bytes()[:-100])
    refused = CliRunner().invoke(main, ["train", "ibc", "--data", "data"])
    assert refused.exit_code == 2
    assert "second-0.hdf5" in refused.stderr
    assert not (workplace / "runs").exists()
