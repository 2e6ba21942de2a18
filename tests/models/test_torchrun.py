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
from models.config import METHODS
from models.distributed import Team
from models.learners import build_learner

TRAIN = textwrap.dedent(
    """
    import dataclasses, os, sys
    from pathlib import Path
    import torch
    from mjdrive.benchmarks.carried import demonstrations
    from models.distributed import joined, team_of
    from models.learners import build_learner
    from models.presets import quick
    from models.training import fit

    folder, epochs = Path(sys.argv[1]), int(sys.argv[2])
    torch.set_num_threads(1)
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
        resume = (folder / "state.json").exists()
        fit(learner, demonstrations(11), config, folder=folder, resume=resume, team=team, on_epoch=stop)
    """
)
MISMATCH = textwrap.dedent(
    """
    import dataclasses, os, sys
    from pathlib import Path
    import torch
    from models.distributed import joined, team_of
    from models.errors import HardwareError
    from models.interfaces import Batch, TensorDemonstrations
    from models.learners import build_learner
    from models.presets import quick
    from models.training import fit

    team = team_of(os.environ)
    num, precision = ((8, "bfloat16"), (7, "float32"))[team.rank]
    bev, actions = torch.zeros(num, 5, 192, 192, dtype=torch.uint8), torch.zeros(num, 2)
    data = TensorDemonstrations(Batch(bev, torch.zeros(num, 3), actions))
    config = quick("bc-beta")
    settings = dataclasses.replace(config.optimiser, epochs=1, batch_size=4, precision=precision)
    config = dataclasses.replace(config, optimiser=settings)
    try:
        with joined(team, torch.device("cpu")):
            fit(build_learner(config, seed=0), data, config, team=team)
    except HardwareError as error:
        Path(sys.argv[1], f"{team.rank}.txt").write_text(str(error))
    """
)
TORCHRUN = ("-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2")
LARGEST_DIFFERENCE = 1e-3
"""Of how far training moves a weight tensor [-]."""

GRADIENT_DIFFERENCE = {"float32": 1e-4, "bfloat16": 1e-2}
"""Of the norm of a gradient [-]."""

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


def torchrun(script, *arguments):
    """Run a script in two processes."""
    return subprocess.run(
        [sys.executable, *TORCHRUN, str(script), *map(str, arguments)],
        capture_output=True,
        text=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        timeout=240,
        check=False,
    )


def test_a_run_that_two_processes_began_and_one_finished_is_that_of_one(
    train_here, script, tmp_path
):
    result = torchrun(script, tmp_path / "two", 1)
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


def test_processes_that_would_train_different_things_all_refuse_and_say_what_differs(tmp_path):
    script = tmp_path / "train.py"
    script.write_text(MISMATCH)
    result = torchrun(script, tmp_path)
    assert result.returncode == 0, result.stderr
    refusals = {(tmp_path / f"{rank}.txt").read_text() for rank in range(2)}
    assert len(refusals) == 1
    (refusal,) = refusals
    assert "Processes 0 and 1 would not train the same" in refusal
    for difference in ("optimiser.precision: bfloat16, float32", "number of pairs: 8, 7"):
        assert difference in refusal
    assert "seed" not in refusal


def gradients_of_parts(config, demonstrations, rank, size):
    """Loss and gradients that one process of a team adds, minibatch by minibatch."""
    run = training._Run(
        build_learner(config, seed=0),
        demonstrations,
        seed=0,
        device=torch.device("cpu"),
        team=Team(rank, size),
    )
    for minibatch in run._minibatches(run.order.of(0), 0, is_training=True):
        loss = run._differentiate(minibatch)
        yield [torch.tensor(loss), *(gradient.clone() for gradient in run.state.gradients())]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("precision", ["float32", "bfloat16"])
def test_the_gradients_of_the_parts_sum_to_that_of_the_minibatch(
    method, precision, small_config, demonstrations, monkeypatch
):
    """In float32 each tensor, in bfloat16 all of them together, each as a share of its norm."""
    monkeypatch.setattr(training, "sum_over", lambda team, tensors: None)
    # Of 10 pairs: parts of 4 and 5, and of 0 and 1.
    config = small_config(method, batch_size=9, precision=precision)
    sides = (gradients_of_parts(config, demonstrations, *team) for team in ((0, 1), (0, 2), (1, 2)))
    for whole, *parts in zip(*sides, strict=True):
        pairs = [(one, first + second) for one, first, second in zip(whole, *parts, strict=True)]
        if precision == "bfloat16":
            all_of_them = (
                torch.cat([it.flatten() for it in side]) for side in zip(*pairs, strict=True)
            )
            pairs = [tuple(all_of_them)]
        for expected, found in pairs:
            bound = GRADIENT_DIFFERENCE[precision] * float(expected.norm()) + 1e-9
            assert float((found - expected).norm()) <= bound
