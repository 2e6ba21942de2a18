"""A run that is to be replaced stays until the new one is ready for its first step."""

import contextlib
from collections.abc import Callable
from pathlib import Path

import pytest
import torch
from torch import nn

from mjdrive.benchmarks import carried
from mjdrive.errors import RunError
from mjdrive.learning import runs, training
from mjdrive.learning.settings import learner_settings
from models import distributed
from models.distributed import ALONE, Team
from models.errors import HardwareError
from models.interfaces import Learner

CONFIG = learner_settings(
    "bc-beta",
    preset="quick",
    assignments=["optimiser.epochs=1", "optimiser.batch_size=2", "optimiser.precision=float32"],
)
Train = Callable[..., object]


@pytest.fixture(autouse=True)
def _one_thread() -> None:
    torch.set_num_threads(1)


@pytest.fixture
def train(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Train:
    """Trains on four pairs into a folder that holds a run already."""
    pairs = carried.demonstrations(4)
    source = training.Source("town01", "0123", len(pairs), {})
    monkeypatch.setattr(training, "_read", lambda *_: (pairs, source))

    def start(*, seed: int = 0, overwrite: bool = False, team: Team = ALONE) -> None:
        training.train(
            CONFIG,
            data=tmp_path,
            run=tmp_path / "run",
            seed=seed,
            overwrite=overwrite,
            device="cpu",
            team=team,
        )

    start()
    return start


def bytes_of(run: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in run.iterdir()}


def nobody_answers(team: Team, device: torch.device) -> contextlib.AbstractContextManager[None]:
    raise HardwareError("Process 0 of 2 cannot reach the others.")


def test_it_stays_where_the_processes_do_not_find_each_other(
    train: Train, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = bytes_of(tmp_path / "run")
    monkeypatch.setattr(distributed, "joined", nobody_answers)
    with pytest.raises(RunError, match="cannot reach the others"):
        train(overwrite=True, team=Team(0, 2))
    assert bytes_of(tmp_path / "run") == before


def test_it_stays_where_there_are_more_processes_than_pairs(train: Train, tmp_path: Path) -> None:
    before = bytes_of(tmp_path / "run")
    with pytest.raises(RunError, match="3 processes share minibatches of 2 pairs"):
        train(overwrite=True, team=Team(0, 3))
    assert bytes_of(tmp_path / "run") == before


def test_it_stays_where_the_network_does_not_fit_on_the_device(
    train: Train, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = bytes_of(tmp_path / "run")

    def full(self: nn.Module, device: object) -> nn.Module:
        raise torch.OutOfMemoryError("CUDA out of memory.")

    monkeypatch.setattr(Learner, "to", full)
    with pytest.raises(torch.OutOfMemoryError):
        train(overwrite=True)
    assert bytes_of(tmp_path / "run") == before


def test_it_is_replaced_where_the_new_one_can_start(train: Train, tmp_path: Path) -> None:
    before = bytes_of(tmp_path / "run")
    with pytest.raises(RunError, match="holds a training run already"):
        train(seed=1)
    assert bytes_of(tmp_path / "run") == before
    train(seed=1, overwrite=True)
    after = bytes_of(tmp_path / "run")
    assert after.keys() == before.keys() >= {runs.SOURCE}
    assert after["model.safetensors"] != before["model.safetensors"]
