"""What `train` says and refuses before anything is drawn."""

from pathlib import Path

import pytest
import torch
from click.testing import CliRunner

from mjdrive.cli.main import main
from mjdrive.errors import DataError, RunError
from mjdrive.learning import training
from mjdrive.learning.settings import learner_settings
from models import hardware

CONFIG = learner_settings("bc-beta", preset="quick")


def test_a_device_that_is_not_there_is_refused_before_anything_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(RunError, match="There is no device 'cuda' here"):
        training.train(CONFIG, data=tmp_path / "none", run=tmp_path / "run", seed=0, device="cuda")
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("is_fast", "note"),
    [(True, "Training on cpu in bfloat16."), (False, "Training on cpu in float32.")],
)
def test_it_says_where_it_trains_and_in_which_number_format(
    is_fast: bool, note: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hardware, "bfloat16_is_fast", lambda device="cpu": is_fast)
    notes: list[str] = []
    with pytest.raises(DataError):
        training.train(
            CONFIG,
            data=tmp_path / "none",
            run=tmp_path / "run",
            seed=0,
            device="cpu",
            on_note=notes.append,
        )
    assert notes == [note]


def test_half_of_torchruns_environment_is_one_line_and_status_2(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("RANK", "0")
    result = CliRunner().invoke(main, ["train", "bc-beta"])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "half of torchrun's: LOCAL_RANK, WORLD_SIZE, MASTER_ADDR, MASTER_PORT" in result.stderr
