"""A decision by the exact softmax on a grid of 128 x 128 actions, beside our own search with as many candidates."""

import torch

from mjdrive.benchmarks.comparison import Comparison, Plan
from mjdrive.benchmarks.decisions import GRID_POINTS, decision, observation, sampler
from mjdrive.benchmarks.timing import paired
from models.energy_scoring import resolved_for

LEAST = 4.0
"""How many times faster than our search a decision is to be [-]."""


def measure(plan: Plan) -> tuple[Comparison, ...]:
    """Decide on the same observation with the same network.

    Args:
        plan: How much to measure.
    """
    seen, settings = observation(), sampler("grid")
    pair = paired(decision(settings, seen), decision(sampler("dfo"), seen), rounds=plan.rounds(31))
    points = f"{GRID_POINTS} x {GRID_POINTS}"
    return (
        Comparison(
            name="grid decision",
            work=f"one decision, encoder included, in {resolved_for(settings)}",
            ours=f"exact softmax on {points} points",
            theirs="our search, 16384 candidates x 5 passes",
            our_rounds=pair.ours,
            their_rounds=pair.theirs,
            bar=LEAST,
            piece="decision",
            note=f"Wall time; threads: {torch.get_num_threads()}. Five passes and their resampling against one.",
        ),
    )
