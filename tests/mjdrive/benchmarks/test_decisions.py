import dataclasses

import numpy as np
import pytest
import torch

from mjdrive.benchmarks import closed_loop, decisions, dfo, grid
from mjdrive.benchmarks.comparison import Comparison, Figure, Plan
from mjdrive.benchmarks.naive_dfo import NaiveDfo
from mjdrive.datatypes import Action, Observation

SEEN = Observation(bev=np.full((5, 192, 192), 80, np.uint8), state=np.zeros(3, np.float32))


def small_sampler(kind, precision="auto"):
    """As `decisions.sampler`, with few candidates."""
    chosen = decisions.sampler(kind, precision)
    few = dataclasses.replace(chosen.dfo, num_samples=64)
    return dataclasses.replace(chosen, dfo=few, grid=dataclasses.replace(chosen.grid, points=8))


@pytest.fixture(autouse=True)
def _one_thread():
    """Tests run beside each other; networks that fight over cores wait for each other."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


@pytest.fixture
def small(monkeypatch):
    """Benchmarks with little to do."""
    for module in (dfo, grid, closed_loop):
        monkeypatch.setattr(module, "sampler", small_sampler)
    for module in (dfo, grid):
        monkeypatch.setattr(module, "observation", lambda: SEEN)
    monkeypatch.setattr(closed_loop, "QUICK_STEPS", 3)


def test_both_samplers_of_the_table_have_as_many_candidates_as_the_paper():
    assert decisions.sampler("dfo").dfo.num_samples == 16384
    assert decisions.sampler("dfo").dfo.iterations == 5
    assert decisions.sampler("grid").grid.points ** 2 == 16384


@pytest.mark.parametrize("encodes_once", [True, False])
def test_the_naive_search_chooses_as_ours_does(encodes_once):
    """Mean and spread of its actions, at an energy that is made steep."""
    learner = decisions.network(small_sampler("dfo"))
    with torch.no_grad():
        learner.energy.last.weight *= 300
    naive = NaiveDfo(learner, encodes_once=encodes_once)
    bev, state = torch.tensor(SEEN.bev)[None], torch.tensor(SEEN.state)[None]
    generator = torch.Generator().manual_seed(0)
    ours, theirs = (
        torch.cat([way.act(bev, state, generator=generator) for _ in range(100)])
        for way in (learner, naive)
    )
    assert ours.std(0).min() > 0.01
    error = (ours.var(0) / len(ours) + theirs.var(0) / len(theirs)).sqrt()
    assert ((ours.mean(0) - theirs.mean(0)).abs() < 4 * error).all()
    assert (ours.std(0) / theirs.std(0)).log().abs().max() < 0.35


@pytest.mark.usefixtures("small")
def test_decisions_are_rows_of_the_table(tmp_path):
    plan = Plan(tmp_path, quick=True)
    rows = (*dfo.measure(plan), *grid.measure(plan))
    assert [type(row) for row in rows] == [Comparison, Comparison, Figure, Figure, Comparison]
    assert [row.bar for row in rows if isinstance(row, Comparison)] == [8.0, 8.0, 4.0]
    assert all("wall time" in row.note.lower() for row in rows)


@pytest.mark.usefixtures("small")
def test_closed_loops_are_shown_for_3000_steps(tmp_path):
    rows = closed_loop.measure(Plan(tmp_path, quick=True))
    assert [row.most for row in rows] == [300.0, 60.0, 30.0]
    assert all("From 3 steps" in row.note for row in rows)


def test_the_policy_decides_at_each_step_of_a_closed_loop():
    decided = []

    class Counting:
        name = "counting"

        def reset(self, seed):
            decided.clear()

        def act(self, seen):
            decided.append(seen.state[0])
            return Action(acceleration=-1.0, steering=0.0)  # which is not driven

    simulation = closed_loop.Simulation(closed_loop.library.load("town02"))
    episode = closed_loop.drive(simulation, Counting(), num_steps=20)()
    assert len(decided) == 20
    assert decided[-1] > 1  # the car gets about
    assert episode.policy == "pid"
