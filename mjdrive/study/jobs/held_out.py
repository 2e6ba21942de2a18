"""The expert's walk through the town that agents drive in: how likely do agents find what it does there?

None of them has seen the town. The density of every method is told at all points of one grid, normalised over them, and
read at the point nearest to what the expert did, so that all methods can be compared. Explicit methods and energies tell
it exactly; that of diffusion and flow is approximate, from an ODE of a few steps that ends at a floor of noise.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float

from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Episode, Observation, Town
from mjdrive.episodes.views import states
from mjdrive.evaluation import lane_keeping
from mjdrive.evaluation.choices import approaches
from mjdrive.evaluation.landscape import entropy_bits, modes
from mjdrive.study.jobs.landscapes import POINTS, action_grid, normalised
from mjdrive.study.records.measures import LandscapeFigures, Likelihood
from mjdrive.town.lane_graph import lane_length
from models.interfaces import Learner
from models.threads import one_thread

NEAR_JUNCTION = 12.0
"""A moment so near before a junction with a choice counts as one of it [m]."""


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Moments of the expert's walk.

    Attributes:
        observations: What an agent would have seen.
        labels: What the expert did, shape (N, 2) [-].
        at_junction: Whether it was in a junction or near before one with a choice, shape (N,).
    """

    observations: tuple[Observation, ...]
    labels: Float[np.ndarray, "N 2"]
    at_junction: Bool[np.ndarray, " N"]


def held_out(
    episodes: Sequence[Episode], town: Town, *, num_frames: int, rng: np.random.Generator
) -> HeldOut:
    """Draw moments from the expert's walk.

    Args:
        episodes: The walk.
        town: Where.
        num_frames: How many moments, or all if there are fewer [-].
        rng: Source of the draw.
    """
    total = sum(len(episode.time) for episode in episodes)
    chosen = np.sort(rng.choice(total, size=min(num_frames, total), replace=False))
    projector = BevProjector(town)
    seen, labels, at_junction, first = [], [], [], 0
    for episode in episodes:
        rows = chosen[(chosen >= first) & (chosen < first + len(episode.time))] - first
        state = states(episode)
        near = _at_junction(episode, town)
        for row in rows.tolist():
            seen.append(Observation(projector.replay(episode, row), state[row].copy()))
            labels.append(episode.labels[row])
            at_junction.append(bool(near[row]))
        first += len(episode.time)
    return HeldOut(tuple(seen), np.array(labels), np.array(at_junction))


@torch.no_grad()
def judge(learner: Learner, moments: HeldOut) -> tuple[Likelihood, LandscapeFigures]:
    """Ask an agent what it thinks of all actions at all moments.

    Args:
        learner: Trained network with the settings that it acts with, ready to act.
        moments: When.

    Returns:
        How likely it finds what the expert did, and how many ways to act it sees at junctions.
    """
    grid = action_grid(POINTS)[None]
    gains, shapes = [], []
    with one_thread():
        for observation, label, is_near in zip(
            moments.observations, moments.labels, moments.at_junction, strict=True
        ):
            bev, state = torch.tensor(observation.bev)[None], torch.tensor(observation.state)[None]
            told = learner.log_density(bev, state, grid)[0].double().numpy()
            gains.append(gain(told.reshape(POINTS, POINTS), label))
            if is_near:
                probabilities = normalised(told.reshape(POINTS, POINTS))
                masses = [mode.mass for mode in modes(probabilities)]
                shapes.append((len(masses), max(masses, default=0.0), entropy_bits(probabilities)))
    return _likelihood(np.array(gains), moments.at_junction), _figures(np.array(shapes))


def gain(log_density: Float[np.ndarray, "A S"], label: Float[np.ndarray, "2"]) -> float:
    """Log probability of the point of the grid nearest to an action, above that of a uniform distribution [nats].

    Args:
        log_density: Of an even grid over [-1, 1] x [-1, 1], acceleration outermost, up to a constant [nats].
        label: The action [-].
    """
    highest = log_density.max()
    log_sum = highest + math.log(np.exp(log_density - highest).sum())
    size = np.array(log_density.shape)
    row, column = np.clip(np.rint((label + 1) / 2 * (size - 1)), 0, size - 1).astype(int)
    return float(log_density[row, column] - log_sum + math.log(log_density.size))


def _likelihood(gains: Float[np.ndarray, " N"], at_junction: Bool[np.ndarray, " N"]) -> Likelihood:
    error = float(gains.std(ddof=1)) / math.sqrt(len(gains)) if len(gains) > 1 else 0.0
    return Likelihood(
        frames=len(gains),
        gain=round(float(gains.mean()), 4),
        error=round(error, 4),
        junction_gain=round(float(gains[at_junction].mean()), 4) if at_junction.any() else None,
    )


def _figures(shapes: np.ndarray) -> LandscapeFigures:
    """Mean number of modes, largest mass and entropy of as many landscapes as there are rows."""
    if not len(shapes):
        return LandscapeFigures(frames=0, modes=0.0, multimodal=0.0, heaviest=0.0, entropy=0.0)
    return LandscapeFigures(
        frames=len(shapes),
        modes=round(float(shapes[:, 0].mean()), 4),
        multimodal=round(float((shapes[:, 0] > 1).mean()), 4),
        heaviest=round(float(shapes[:, 1].mean()), 4),
        entropy=round(float(shapes[:, 2].mean()), 4),
    )


def _at_junction(episode: Episode, town: Town) -> Bool[np.ndarray, " T"]:
    lanes = lane_keeping.track(episode, town)
    forks = {approach.lane for approach in approaches(town)}
    left = [
        lane_length(town.lanes[name]) - station if name in forks else math.inf
        for name, station in zip(lanes.lane, lanes.station.tolist(), strict=True)
    ]
    return np.asarray(lanes.in_junction | (np.array(left) < NEAR_JUNCTION))
