"""Two processes that torchrun starts train as one does."""

import os
import runpy
import subprocess
import sys
import textwrap

import pytest
import torch
from safetensors.torch import load_file

from models import training
from models.distributed import Team
from models.learners import build_learner

TRAIN = textwrap.dedent(
    """
    import dataclasses, os, sys
    from pathlib import Path
    import torch
    from models.distributed import joined, team_of
    from models.interfaces import Batch, TensorDemonstrations
    from models.learners import build_learner
    from models.presets import quick
    from models.training import fit

    folder, epochs = Path(sys.argv[1]), int(sys.argv[2])
    torch.set_num_threads(1)
    generator = torch.Generator().manual_seed(0)
    bev = torch.randint(0, 256, (11, 5, 192, 192), generator=generator, dtype=torch.uint8)
    state = torch.rand(11, 3, generator=generator)
    actions = 2 * torch.rand(11, 2, generator=generator) - 1
    config = quick("da-ibc")
    config = dataclasses.replace(
        config,
        network=dataclasses.replace(config.network, state_dropout=0.3),
        density=dataclasses.replace(config.density, weighting="loss"),
        # Minibatches of 5, 5 and 1: parts of 2 and 3, and one of nothing.
        optimiser=dataclasses.replace(
            config.optimiser, schedule="constant", learning_rate=1e-4, epochs=2, batch_size=5, precision="float32",
        ),
    )

    def stop(report):
        if report.epoch == epochs:
            raise SystemExit

    learner, team = build_learner(config, seed=0), team_of(os.environ)
    with joined(team, torch.device("cpu")):
        demonstrations = TensorDemonstrations(Batch(bev, state, actions))
        resume = (folder / "state.json").exists()
        fit(learner, demonstrations, config, folder=folder, resume=resume, team=team, on_epoch=stop)
    """
)
TORCHRUN = ("-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2")
LARGEST_DIFFERENCE = 1e-3
"""Of how far training moves a weight tensor [-]."""

WITHOUT_EFFECT = {"experts.actions", "experts.density", "energy.last.bias", "energy.second.bias"}
"""No weights, or biases that the softmax cancels wherever a unit is active for all candidates: what gradient is left
is rounding, and Adam makes steps of full length of it."""


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "train.py"
    path.write_text(TRAIN)
    return path


@pytest.fixture
def train_here(script, monkeypatch):
    """Train in this process into a folder, up to an epoch."""

    def train(folder, epochs):
        monkeypatch.setattr(sys, "argv", [str(script), str(folder), str(epochs)])
        with pytest.raises(SystemExit):
            runpy.run_path(str(script), run_name="__main__")
        return load_file(folder / "model.safetensors")

    return train


def test_a_run_that_two_processes_began_and_one_finished_is_that_of_one(
    train_here, script, tmp_path
):
    result = subprocess.run(
        [sys.executable, *TORCHRUN, str(script), str(tmp_path / "two"), "1"],
        capture_output=True,
        text=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        timeout=240,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    assert len((tmp_path / "two/metrics.jsonl").read_text().splitlines()) == 1
    start, *ends = (
        train_here(tmp_path / name, epochs) for name, epochs in (("one", 1), ("one", 2), ("two", 2))
    )
    differences = {
        name: float((weight - ends[0][name]).norm() / (ends[0][name] - start[name]).norm())
        for name, weight in ends[1].items()
        if name not in WITHOUT_EFFECT
    }
    assert max(differences.values()) < LARGEST_DIFFERENCE, differences


@pytest.mark.parametrize("method", ["bc-beta", "ibc", "da-ibc"])
def test_the_gradients_of_the_parts_sum_to_that_of_the_minibatch(
    method, small_config, demonstrations, monkeypatch
):
    monkeypatch.setattr(training, "sum_over", lambda team, tensors: None)
    config = small_config(method, batch_size=9)  # of 10 pairs: parts of 4 and 5, and of 0 and 1

    def gradients(rank, size):
        run = training._Run(
            build_learner(config, seed=0),
            demonstrations,
            seed=0,
            device=torch.device("cpu"),
            team=Team(rank, size),
        )
        for minibatch in run._minibatches(run._order(0), 0, is_training=True):
            loss = run._differentiate(minibatch)
            yield [torch.tensor(loss), *(gradient.clone() for gradient in run.state.gradients())]

    for whole, *parts in zip(gradients(0, 1), gradients(0, 2), gradients(1, 2), strict=True):
        for expected, first, second in zip(whole, *parts, strict=True):
            scale = float(expected.norm())
            torch.testing.assert_close(first + second, expected, rtol=0, atol=1e-4 * scale + 1e-9)
