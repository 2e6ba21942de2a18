"""Policies are chosen by a name in the list, and loading one runs nothing that it brings along."""

import pickle
import shutil
from pathlib import Path

import numpy as np
import pytest
import torch

from mjdrive.errors import RunError
from mjdrive.simulation.simulation import Simulation
from mjdrive.web.choices import load_mind
from mjdrive.web.policies import POINTS, PilotMind, shade
from mjdrive.zoo import entries
from models import checkpoint
from models.samplers.grid import action_grid


def test_weights_are_never_a_pickle(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[object, ...]:
            return (tmp_path.joinpath("sprung").touch, ())

    run = tmp_path / "runs" / "trap"
    shutil.copytree(entries.FOLDER / entries.DEFAULT, run)
    for name in (checkpoint.MODEL, checkpoint.TRAINING):
        (run / name).write_bytes(pickle.dumps(Trap()))
    with pytest.raises(RunError):
        load_mind("trap", run.parent)
    assert not (tmp_path / "sprung").exists()
    pickle.loads((run / checkpoint.MODEL).read_bytes())
    assert (tmp_path / "sprung").exists()  # it would have


def test_the_landscape_is_that_which_was_chosen_from(simulation: Simulation) -> None:
    mind = load_mind(entries.PREFIX + entries.DEFAULT, Path())
    assert isinstance(mind, PilotMind)
    mind.begin(simulation, 0)
    learner = mind._pilot.learner
    side = learner.config.sampler.grid.points
    for _ in range(3):
        seen = simulation.observe()
        simulation.step(mind.decide(simulation, seen))
        found = mind.chosen_from()
        assert found is not None
        bev, state = torch.tensor(seen.bev)[None], torch.tensor(seen.state)[None]
        told = learner.log_density(bev, state, action_grid(side)[None]).view(1, side, side)
        expected = shade(torch.nn.functional.adaptive_max_pool2d(told, POINTS)[0].double().numpy())
        # Energies to choose from may be in bfloat16.
        assert np.abs(found.pixels.astype(float) - expected.pixels).mean() <= 3
        assert (found.low, found.high) == pytest.approx((expected.low, expected.high), abs=0.5)
        asked = mind.density(seen)
        assert asked.pixels.shape == found.pixels.shape
