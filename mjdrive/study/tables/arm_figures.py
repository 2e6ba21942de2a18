"""Figures of one agent in one way to act, over all of its drives."""

from collections.abc import Callable

from mjdrive.evaluation.forking import mean_outcome, mean_taken
from mjdrive.study.records.measures import Curve, DriveFigures
from mjdrive.study.records.results import ArmResult

_STEP_S = 0.1
"""A control step, by which a drive may fall short of its time [s]."""


def total(figure: Callable[[DriveFigures], float]) -> Callable[[ArmResult], float]:
    """The sum of a figure over the drives of an agent, in its own unit."""
    return lambda result: sum(figure(drive) for drive in result.drives)


def km_to_half(result: ArmResult) -> float | None:
    """Distance until half of the directed lanes were visited in the drives of the tables [km]; None if they never were."""
    return _half(result.coverage)


def km_to_half_in_all(result: ArmResult) -> float | None:
    """The same in the drives of the tables and then the long drive [km]."""
    return _half(result.all_coverage)


def _half(curve: Curve) -> float | None:
    """Where a curve comes to a half; None if it does not."""
    reached = zip(curve.x, curve.share, strict=True)
    return next((x for x, share in reached if share >= 0.5), None)


def recall_by(result: ArmResult, seconds: float) -> float | None:
    """Branch recall after so long in the drives of the tables and then the long drive [-]; None if they end before."""
    if result.recall.x[-1] < seconds - _STEP_S:
        return None
    reached = zip(result.recall.x, result.recall.share, strict=True)
    return max(share for x, share in reached if x <= seconds)


def mode_precision(result: ArmResult) -> float | None:
    """Share of rollouts from moments before junctions that were still on the road 5 s later [-]."""
    return mean_outcome(result.forks)[0] if result.forks else None


def exits_taken(result: ArmResult) -> float | None:
    """Share of the same rollouts that drove safely through an exit, which one that stops does not [-]."""
    return mean_taken(result.forks) if result.forks else None


def conditional_entropy(result: ArmResult) -> float | None:
    """Entropy of the exits taken from one moment over its largest value, mean over moments [-]."""
    return mean_outcome(result.forks)[1] if result.forks else None


def num_modes(result: ArmResult) -> float | None:
    """Mean number of ways to act that an agent sees at junctions [-]."""
    return result.landscape.modes if result.landscape and result.landscape.frames else None


def share_multimodal(result: ArmResult) -> float | None:
    """Share of the moments at junctions at which an agent sees several ways to act [-]."""
    return result.landscape.multimodal if result.landscape and result.landscape.frames else None


def heaviest_mode(result: ArmResult) -> float | None:
    """Mean mass of the heaviest way to act at junctions [-]."""
    return result.landscape.heaviest if result.landscape and result.landscape.frames else None


def junction_entropy(result: ArmResult) -> float | None:
    """Mean entropy of what an agent thinks of all actions at junctions [bit]."""
    return result.landscape.entropy if result.landscape and result.landscape.frames else None


def held_out_gain(result: ArmResult) -> float | None:
    """Held-out log-likelihood above a uniform one [nats]."""
    return result.likelihood.gain if result.likelihood else None


def junction_gain(result: ArmResult) -> float | None:
    """The same at junctions [nats]."""
    return result.likelihood.junction_gain if result.likelihood else None
