"""One decision of a learned policy: the network and the observation that decisions are timed with.

The network has the paper's settings and first weights, not trained ones: what a decision takes does not depend on them.
"""

import dataclasses
from collections.abc import Callable
from typing import Literal

import numpy as np
import torch

from mjdrive.datatypes import Observation
from mjdrive.learning.pilot import Pilot
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing
from models import presets
from models.config import Precision, SamplerConfig
from models.ibc import IbcLearner
from models.learners import build_learner

NUM_DEMONSTRATIONS = 21_287
"""Samples of the study, from whose actions a search begins [-]."""

GRID_POINTS = 128
"""Points along each axis, so that a grid has as many as the paper's search has candidates [-]."""


def sampler(kind: Literal["dfo", "grid"], precision: Precision = "auto") -> SamplerConfig:
    """The paper's search, or a grid of as many points.

    Args:
        kind: Which of the two.
        precision: In which candidates are scored.
    """
    paper = presets.paper("da-ibc").sampler
    grid = dataclasses.replace(paper.grid, points=GRID_POINTS)
    return dataclasses.replace(paper, kind=kind, grid=grid, precision=precision)


def network(settings: SamplerConfig) -> IbcLearner:
    """A DA-IBC network with the paper's sizes.

    Args:
        settings: How it chooses.
    """
    config = dataclasses.replace(presets.paper("da-ibc"), sampler=settings)
    learner = build_learner(config, seed=0)
    assert isinstance(learner, IbcLearner), "DA-IBC is one"
    generator = torch.Generator().manual_seed(0)
    actions = 2 * torch.rand(NUM_DEMONSTRATIONS, 2, generator=generator) - 1
    learner.prepare(actions, torch.rand(NUM_DEMONSTRATIONS, generator=generator) + 0.1)
    return learner.eval()


def observation() -> Observation:
    """What is seen from a random place in town02."""
    simulation = Simulation(library.load("town02"))
    lane, station = routing.random_start(simulation.town, np.random.default_rng(0))
    simulation.reset(lane=lane, station=station, seed=0)
    return simulation.observe()


def decision(settings: SamplerConfig, seen: Observation) -> Callable[[], object]:
    """A decision as `mjdrive drive` makes it, encoder and copies included.

    Args:
        settings: How it chooses.
        seen: What it decides on.
    """
    pilot = Pilot(network(settings), name="DA-IBC", device="cpu")  # where the naive side is
    pilot.reset(0)
    return lambda: pilot.act(seen)
