"""Searches the settings that drive a car best, by covariance matrix adaptation.

Reference:
    Hansen, The CMA Evolution Strategy: A Tutorial, arXiv 1604.00772, 2016 (the `cma` package).
"""

from collections.abc import Callable
from dataclasses import dataclass

import cma
import numpy as np

from mjdrive.config import TuneConfig
from mjdrive.tuning.knobs import ExpertConfig, Knob, places_of, turned
from mjdrive.tuning.marks import Marks

Trial = Callable[[ExpertConfig], Marks]
"""Drives the course with some settings."""

OUTSIDE_COST = 100.0
"""Cost of a knob beyond its limits, per square of its range [-]; only the search sees it."""


@dataclass(frozen=True, slots=True)
class Tried:
    """One trial.

    Attributes:
        settings: What was tried.
        marks: How it drove.
    """

    settings: ExpertConfig
    marks: Marks


def search(
    start: ExpertConfig,
    knobs: tuple[Knob, ...],
    trial: Trial,
    *,
    config: TuneConfig,
    seed: int,
    on_trial: Callable[[Tried], None] = lambda tried: None,
) -> tuple[Tried, ...]:
    """Try settings, each generation nearer to the best of the one before.

    Args:
        start: Where to begin; the first trial.
        knobs: What may change.
        trial: Drives the course.
        config: How many trials, and how far apart the first are.
        seed: The same seed tries the same settings.
        on_trial: Told of each trial.

    Returns:
        All trials in their order, the start first.
    """
    tried = [Tried(start, trial(start))]
    on_trial(tried[0])
    options = {"seed": seed + 1, "verbose": -9, "verb_log": 0}  # cma takes a seed of 0 for the time
    strategy = cma.CMAEvolutionStrategy(places_of(start, knobs), config.spread, options)
    while len(tried) < config.trials:
        generation = [np.asarray(places) for places in strategy.ask()]
        costs = []
        for places in generation[: config.trials - len(tried)]:
            settings = turned(start, knobs, places)
            tried.append(Tried(settings, trial(settings)))
            outside = places - np.clip(places, 0.0, 1.0)
            costs.append(tried[-1].marks.cost + OUTSIDE_COST * float(outside @ outside))
            on_trial(tried[-1])
        if len(costs) == len(generation):
            strategy.tell(generation, costs)
    return tuple(tried)


def best(tried: tuple[Tried, ...]) -> Tried:
    """The cheapest trial, the earliest of equals."""
    return min(tried, key=lambda one: one.marks.cost)
