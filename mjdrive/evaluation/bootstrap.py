"""How sure a mean over training seeds and episodes is.

Means and rates only, no interquartile mean: what that cuts off are the few drives in which something was hit, and those
are what is counted here.

Reference:
    Agarwal et al., Deep Reinforcement Learning at the Edge of the Statistical Precipice, NeurIPS 2021: bootstrap over
    runs. There each task has runs of its own; here one trained policy drives every episode, so what is drawn anew is
    whole runs.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

Statistic = Callable[..., np.ndarray]
"""Figures, each of shape (..., S, E), to one for each table of seeds and episodes, shape (...)."""


@dataclass(frozen=True, slots=True)
class Interval:
    """A figure with its bootstrap interval, in the figure's unit.

    Attributes:
        value: Of what was measured.
        low: Lower end.
        high: Upper end.
    """

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """Value and interval, as a table has them."""
        digits = 0 if abs(self.value) >= 100 else 2
        return f"{self.value:,.{digits}f} [{self.low:,.{digits}f}, {self.high:,.{digits}f}]"


def mean(figures: Float[np.ndarray, "*B S E"]) -> Float[np.ndarray, "*B"]:
    """Mean over seeds and episodes."""
    return np.asarray(figures.mean(axis=(-2, -1)))


def total(figures: Float[np.ndarray, "*B S E"]) -> Float[np.ndarray, "*B"]:
    """Sum over episodes, mean over seeds."""
    return np.asarray(figures.sum(axis=-1).mean(axis=-1))


def rate(
    above: Float[np.ndarray, "*B S E"], below: Float[np.ndarray, "*B S E"]
) -> Float[np.ndarray, "*B"]:
    """Sum of one figure over that of another, both over seeds and episodes; NaN where the other is nothing."""
    divisor = below.sum(axis=(-2, -1))
    nothing = np.full(np.shape(divisor), np.nan)
    return np.divide(above.sum(axis=(-2, -1)), divisor, out=nothing, where=divisor > 0)


def interval(
    *figures: Float[np.ndarray, "S E"],
    rng: np.random.Generator,
    statistic: Statistic = mean,
    level: float = 0.95,
    num_draws: int = 2000,
) -> Interval:
    """Bootstrap a figure over training seeds and, within them, over episodes.

    In each draw whole seeds are drawn with replacement, and episodes likewise, the same ones for all seeds: what a seed
    has learnt shows in all of its episodes, and a hard start in the episodes of all seeds, so neither is independent
    evidence. With three to five seeds such intervals are still too narrow (tests/mjdrive/evaluation/test_bootstrap.py
    says by how much); with one they say nothing of training. What never happened has the interval [0, 0], as what is drawn is
    only what was seen.

    Args:
        *figures: One for each training seed and episode, in any unit; all seeds drive from the same starts. Of several,
            as those of a rate, each draw takes the same seeds and episodes.
        rng: Source of the draws.
        statistic: What is made of them.
        level: Share of the draws inside the interval [-].
        num_draws: How many [-].

    Returns:
        The figure and its percentile interval; draws of which the statistic makes NaN are left out, and all is NaN if it
        makes that of the figures themselves.
    """
    drawn = _drawn(figures, _episodes(figures[0], rng, num_draws), rng)
    return _interval(float(statistic(*figures)), statistic(*drawn), level)


def ratio_interval(
    figures: Float[np.ndarray, "S E"],
    reference: Float[np.ndarray, "R F"],
    *,
    rng: np.random.Generator,
    statistic: Statistic = mean,
    level: float = 0.95,
    num_draws: int = 2000,
) -> Interval:
    """Bootstrap the ratio of a figure to that of a reference, whose own chance counts, too.

    Where both have as many episodes, they were driven from the same starts, and each draw takes the same ones of both.

    Args:
        figures: One figure for each training seed and episode, in any unit; all seeds drive from the same starts.
        reference: The same of the reference, in the same unit.
        rng: Source of the draws.
        statistic: What is made of them.
        level: Share of the draws inside the interval [-].
        num_draws: How many [-].

    Returns:
        The ratio and its percentile interval [-].
    """
    episodes = _episodes(figures, rng, num_draws)
    is_paired = figures.shape[1] == reference.shape[1]
    above = statistic(*_drawn((figures,), episodes, rng))
    others = episodes if is_paired else _episodes(reference, rng, num_draws)
    below = statistic(*_drawn((reference,), others, rng))
    return _interval(float(statistic(figures) / statistic(reference)), above / below, level)


def _episodes(
    figures: Float[np.ndarray, "S E"], rng: np.random.Generator, num_draws: int
) -> Int[np.ndarray, "D 1 E"]:
    """Draw episodes with replacement, the same ones for all seeds of a draw: they share their starts and lights."""
    num_episodes = figures.shape[1]
    return rng.integers(num_episodes, size=(num_draws, 1, num_episodes))


def _drawn(
    figures: Sequence[Float[np.ndarray, "S E"]],
    episodes: Int[np.ndarray, "D 1 E"],
    rng: np.random.Generator,
) -> list[Float[np.ndarray, "D S E"]]:
    """Draw seeds with replacement, and take the episodes that were drawn."""
    num_seeds = len(figures[0])
    seeds = rng.integers(num_seeds, size=(len(episodes), num_seeds, 1))
    return [it[seeds, episodes] for it in figures]


def _interval(value: float, drawn: Float[np.ndarray, " D"], level: float) -> Interval:
    if math.isnan(value):
        return Interval(value, value, value)
    low, high = np.quantile(drawn[~np.isnan(drawn)], [(1 - level) / 2, (1 + level) / 2])
    return Interval(value, float(low), float(high))
