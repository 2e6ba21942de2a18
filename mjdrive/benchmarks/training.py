"""Training of the paper's networks beside the loop that one writes first."""

import dataclasses
from collections.abc import Callable

import torch

from mjdrive.benchmarks.carried import demonstrations
from mjdrive.benchmarks.comparison import Comparison, Plan, Row
from mjdrive.benchmarks.naive_training import NaiveLoop
from mjdrive.benchmarks.timing import paired
from mjdrive.learning.batches import PackedDemonstrations
from models import presets
from models.config import Method
from models.learners import build_learner
from models.training import fit

STEPS = 6
"""Steps of a round [-]."""

ROUNDS = 5
LEAST: dict[Method, float] = {"da-ibc": 4.0, "bc-beta": 2.0}
"""How many times more samples a second than the naive side [-]."""


def measure(plan: Plan) -> tuple[Row, ...]:
    """Train DA-IBC with the paper's 1024 negatives, and BC-Beta, each beside its naive loop.

    Args:
        plan: How much to measure.
    """
    return tuple(compare(method, plan) for method in LEAST)


def compare(method: Method, plan: Plan) -> Comparison:
    """Train one method in both ways on the same pairs, an epoch a round.

    Args:
        method: Which.
        plan: How much to measure.
    """
    plan.on_stage(method)
    config = presets.paper(method)
    batch_size, count = config.optimiser.batch_size, config.negatives.count
    num_negatives = 0 if method == "bc-beta" else count
    pairs = demonstrations(STEPS * batch_size)
    ours = epoch(method, pairs)
    theirs = NaiveLoop(pairs, batch_size=batch_size, num_negatives=num_negatives)
    times = paired(ours, theirs, rounds=plan.rounds(ROUNDS))
    beside = f" x {num_negatives} negatives" if num_negatives else ""
    return Comparison(
        name=f"training, {method}",
        work=f"a training step, batch {batch_size}{beside}",
        ours="mjdrive train, preset paper",
        theirs="uint8 images in a DataLoader, float32" + (", late fusion" if beside else ""),
        our_rounds=times.ours,
        their_rounds=times.theirs,
        bar=LEAST[method],
        pieces=float(STEPS),
        piece="step",
        note=f"{torch.get_num_threads()} threads; ours makes the next minibatch in a thread of its own, the DataLoader "
        f"has no worker process; loading of minibatches included; wall time.",
    )


def epoch(method: Method, pairs: PackedDemonstrations) -> Callable[[], object]:
    """An epoch of the paper's preset, as `mjdrive train` does it, on a network that goes on learning.

    Args:
        method: Which.
        pairs: What to learn from.
    """
    config = presets.paper(method)
    config = dataclasses.replace(config, optimiser=dataclasses.replace(config.optimiser, epochs=1))
    learner = build_learner(config, seed=0)
    return lambda: fit(learner, pairs, learner.config)
