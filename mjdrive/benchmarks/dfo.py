"""A decision by the paper's search, 16384 candidates scored five times, beside how published code makes it."""

from collections.abc import Callable

import torch

from mjdrive.benchmarks.comparison import Comparison, Figure, Plan, Row
from mjdrive.benchmarks.decisions import decision, network, observation, sampler
from mjdrive.benchmarks.naive_dfo import NaiveDfo
from mjdrive.benchmarks.timing import Pair, alone, paired
from mjdrive.datatypes import Observation
from models.energy_scoring import resolved

LEAST = 8.0
"""How many times faster than the naive side a decision is to be [-]."""

MOST_MS = 100.0
"""What a decision may take to keep up with 10 control steps a second [ms]."""

WORK = "one decision, 16384 candidates x 5 passes, encoder included"


def measure(plan: Plan) -> tuple[Row, ...]:
    """Decide on the same observation with the same network.

    Args:
        plan: How much to measure.
    """
    seen, rounds = observation(), plan.rounds(11)
    ours = decision(sampler("dfo"), seen)
    plan.on_stage("as diffusion_policy searches")
    once = paired(ours, naive_decision(seen, encodes_once=True), rounds=rounds)
    plan.on_stage("as kevinzakka/ibc searches")
    each = paired(ours, naive_decision(seen, encodes_once=False), rounds=rounds)
    plan.on_stage("in float32")
    single = alone(decision(sampler("dfo", "float32"), seen), rounds=rounds)
    return (
        _comparison("DFO decision", "diffusion_policy's way: encoder once", once),
        _comparison("DFO decision 2", "kevinzakka/ibc's way: encoder at each pass", each),
        _figure("DFO decision, time", f"{WORK}, in {resolved('auto')}", once.ours, most=MOST_MS),
        _figure("DFO decision, float32", f"{WORK}, where bfloat16 is not fast", single),
    )


def naive_decision(seen: Observation, *, encodes_once: bool) -> Callable[[], object]:
    """A decision as published code makes it.

    Args:
        seen: What it decides on.
        encodes_once: As diffusion_policy does, or as kevinzakka/ibc does.
    """
    naive = NaiveDfo(network(sampler("dfo")), encodes_once=encodes_once)
    generator = torch.Generator().manual_seed(0)
    bev, state = torch.tensor(seen.bev)[None], torch.tensor(seen.state)[None]
    return lambda: naive.act(bev, state, generator=generator)


def _comparison(name: str, theirs: str, pair: Pair) -> Comparison:
    return Comparison(
        name=name,
        work=WORK,
        ours=f"mjdrive in {resolved('auto')}",
        theirs=f"{theirs}, candidates tiled, float32",
        our_rounds=pair.ours,
        their_rounds=pair.theirs,
        bar=LEAST,
        piece="decision",
        note=f"Same network, settings and threads ({torch.get_num_threads()}) on both sides; wall time.",
    )


def _figure(
    name: str, work: str, seconds: tuple[float, ...], *, most: float | None = None
) -> Figure:
    return Figure(
        name=name,
        work=work,
        rounds=tuple(1e3 * each for each in seconds),
        unit="ms",
        most=most,
        note=f"Wall time; threads: {torch.get_num_threads()}.",
    )
