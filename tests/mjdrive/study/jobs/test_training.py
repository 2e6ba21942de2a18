"""How the agents of a study are trained."""

from contextlib import nullcontext
from pathlib import Path

import pytest
import torch

from mjdrive.execution.serial import SerialExecutor
from mjdrive.study.jobs import training
from mjdrive.study.jobs.shared_folders import SharedFolders
from mjdrive.study.jobs.training import TrainingJob, train_all
from models import presets


def test_each_training_has_its_own_number_of_threads_whatever_the_machine_has(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    seen = []
    monkeypatch.setattr(training, "marked", lambda runs, data: nullcontext(SharedFolders({})))
    monkeypatch.setattr(training, "train", lambda *_, **__: seen.append(torch.get_num_threads()))
    jobs = [
        TrainingJob(
            name=f"run-{threads}",
            config=presets.quick("bc-beta"),
            seed=0,
            data=tmp_path,
            run=tmp_path / f"run-{threads}",
            keep_every=0,
            num_steps=1,
            threads=threads,
            device="cpu",
        )
        for threads in (1, 3)
    ]
    before = torch.get_num_threads()
    torch.set_num_threads(2)
    try:
        train_all(jobs, executor=SerialExecutor(), report=lambda name, done, expected: None)
        assert torch.get_num_threads() == 2, "who trains here has his threads back"
    finally:
        torch.set_num_threads(before)
    assert seen == [1, 3]
