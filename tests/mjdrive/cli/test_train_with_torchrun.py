"""`torchrun -m mjdrive train`: two processes leave the run of one."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from safetensors.torch import load_file

from mjdrive.cli.main import main
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Town
from mjdrive.episodes import demonstrations
from mjdrive.learning.settings import learner_settings
from models.learners import build_learner

TORCHRUN = ("-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2")
SETTINGS = (
    "optimiser.epochs=2",
    "optimiser.batch_size=25",  # parts of 12 and 13
    "optimiser.precision=float32",
    "optimiser.learning_rate=1e-4",
)
LARGEST_DIFFERENCE = 1e-4
"""Of how far training moves a weight tensor; 5e-6 were seen [-]."""


def words(run: str) -> list[str]:
    options = [word for setting in SETTINGS for word in ("--set", setting)]
    return ["train", "bc-beta", "--preset", "quick", *options, "--data", "data", "--out", run]


@pytest.mark.slow
def test_two_processes_train_as_one_does(
    town02: Town, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    settings = CollectConfig(random_walk_km=0.05)
    demonstrations.collect(town02, {}, tmp_path / "data", settings=settings, seed=0)
    result = CliRunner().invoke(main, words("one"), catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    both = subprocess.run(
        [sys.executable, *TORCHRUN, "-m", "mjdrive", *words("two")],
        capture_output=True,
        text=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        timeout=240,
        check=False,
    )
    assert both.returncode == 0, both.stderr
    assert both.stdout.count("Next: mjdrive drive") == 1, "one process of both speaks"

    names = {path.name for path in (tmp_path / "one").iterdir()}
    assert {path.name for path in (tmp_path / "two").iterdir()} == names
    for name in ("config.json", "state.json", "source.json"):
        assert (tmp_path / "two" / name).read_bytes() == (tmp_path / "one" / name).read_bytes()
    losses = [
        [
            json.loads(line)["loss"]
            for line in (tmp_path / run / "metrics.jsonl").read_text().splitlines()
        ]
        for run in ("one", "two")
    ]
    assert losses[1] == pytest.approx(losses[0], rel=1e-4)
    start = build_learner(
        learner_settings("bc-beta", preset="quick", assignments=SETTINGS), seed=0
    ).state_dict()
    one, two = (load_file(tmp_path / run / "model.safetensors") for run in ("one", "two"))
    moved = {name: float((one[name] - start[name]).norm()) for name in one}
    differences = {
        name: float((two[name] - one[name]).norm()) / moved[name] for name in one if moved[name]
    }
    assert len(differences) > 10
    assert max(differences.values()) < LARGEST_DIFFERENCE, differences
