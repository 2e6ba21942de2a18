"""What a policy chooses where the road forks: recall, entropy and calibration of the ways that it takes.

A policy that drives safely and always turns right is no good driver of a city, and one that turns at random into walls is
none either. These figures say how much of the choice there is a policy makes use of; they count only ways that were
driven from their first point to their last.

Reference:
    Miller, Note on the bias of information estimates, 1955 (entropy of small samples); Lin, Divergence measures based on
    the Shannon entropy, 1991; Jia et al., Towards Diverse Behaviors (D3IL), ICLR 2024 (behaviour entropy).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mjdrive.datatypes import Move, Town
from mjdrive.town.lane_graph import onward

ENOUGH_PASSES = 20
"""An approach passed less often than this says nothing on the entropy of the choices there [-]."""

NUM_DRAWS = 2000
"""Draws of a calibrated policy that the floor of the divergence is averaged over [-]."""


@dataclass(frozen=True, slots=True)
class Approach:
    """A lane where one has to choose.

    Attributes:
        lane: Name of the lane that leads into the junction.
        exits: Names of the junction lanes that lead on from it.
        shares: How often the expert's random walk takes each of them [-].
    """

    lane: str
    exits: tuple[str, ...]
    shares: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ChoiceStatistics:
    """The choices of a policy at the junctions of a town; None where it never came to one.

    Attributes:
        branches: Ways through junctions, pairs of approach and exit, that the town has [-].
        taken: Of these, ways taken at least once [-].
        recall: Taken over all [-].
        passes: Times that it came through a junction with a choice [-].
        entropy: Entropy of the exit over its largest value, corrected for small samples by Miller and Madow; mean over
            passes through approaches that were passed 20 times or more [-].
        divergence: Jensen-Shannon divergence of the exits from those of the expert's random walk, mean over passes [bit].
        divergence_floor: What the same number of passes shows of a policy that chooses as the expert does [bit].
        turn_shares: How often it turned left, right or went straight on, by name of the move [-].
        turn_divergence: Jensen-Shannon divergence of these shares from those of an expert at the same approaches [bit].
    """

    branches: int
    taken: int
    recall: float
    passes: int
    entropy: float | None
    divergence: float | None
    divergence_floor: float | None
    turn_shares: Mapping[str, float]
    turn_divergence: float | None


def approaches(town: Town) -> tuple[Approach, ...]:
    """Find every lane from which more than one way leads through a junction.

    Ways that come to a dead end have no share where others lead on for ever, as in the expert's walk.
    """
    ahead = onward(town)
    found = []
    for lane in town.lanes.values():
        exits = tuple(name for name in lane.successors if town.lanes[name].junction is not None)
        if lane.junction is None and len(exits) > 1:
            endless = [math.isinf(ahead[name]) for name in exits]
            weights = np.array(endless if any(endless) else [True] * len(exits), float)
            found.append(Approach(lane.id, exits, tuple((weights / weights.sum()).tolist())))
    return tuple(found)


def choice_statistics(
    counts: Mapping[str, int], town: Town, *, rng: np.random.Generator
) -> ChoiceStatistics:
    """Judge the ways that were taken.

    Args:
        counts: How often each junction lane was driven, by name, from `branches_taken`.
        town: Where.
        rng: Source of the draws that the floor of the divergence is averaged over.
    """
    branches = [name for name, lane in town.lanes.items() if lane.junction is not None]
    taken = sum(counts.get(name, 0) > 0 for name in branches)
    forks = approaches(town)
    seen = [np.array([counts.get(name, 0) for name in fork.exits]) for fork in forks]
    passes = sum(int(exits.sum()) for exits in seen)
    moves = {name: town.lanes[name].move for fork in forks for name in fork.exits}
    turns, expected = _turns(forks, seen, moves)
    return ChoiceStatistics(
        branches=len(branches),
        taken=taken,
        recall=taken / len(branches) if branches else 0.0,
        passes=passes,
        entropy=_mean_entropy(seen),
        divergence=_mean_divergence(forks, seen) if passes else None,
        divergence_floor=_floor(forks, seen, rng) if passes else None,
        turn_shares={
            move.name.lower(): float(turns[move]) / passes for move in sorted(set(moves.values()))
        }
        if passes
        else {},
        turn_divergence=float(jensen_shannon(turns / passes, expected / passes))
        if passes
        else None,
    )


def entropy(counts: Int[np.ndarray, " K"]) -> float:
    """Entropy of the distribution that counts were drawn from, by Miller and Madow.

    Args:
        counts: How often each of K outcomes was seen [-].

    Returns:
        The estimate, at most that of K equal shares [nats]; 0 if nothing was seen.
    """
    total = int(counts.sum())
    if total == 0:
        return 0.0
    shares = counts[counts > 0] / total
    plain = -float(np.sum(shares * np.log(shares)))
    return min(plain + (len(shares) - 1) / (2 * total), math.log(len(counts)))


def jensen_shannon(
    p: Float[np.ndarray, "*B K"], q: Float[np.ndarray, "*B K"]
) -> Float[np.ndarray, "*B"]:
    """Jensen-Shannon divergence of distributions over K outcomes; 0 if equal, 1 if they share no outcome.

    Args:
        p: Shares that sum to one [-].
        q: Shares that sum to one [-].

    Returns:
        One divergence for each pair of distributions [bit].
    """
    mean = 0.5 * (p + q)
    return np.asarray(0.5 * (_relative(p, mean) + _relative(q, mean)))


def _relative(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Relative entropy [bit]; outcomes without a share add nothing."""
    ratio = np.divide(p, q, out=np.ones_like(p), where=p > 0)
    return np.asarray(np.sum(p * np.log2(ratio), axis=-1))


def _mean_entropy(seen: Sequence[np.ndarray]) -> float | None:
    enough = [exits for exits in seen if exits.sum() >= ENOUGH_PASSES]
    if not enough:
        return None
    values = [entropy(exits) / math.log(len(exits)) for exits in enough]
    return float(np.average(values, weights=[exits.sum() for exits in enough]))


def _mean_divergence(forks: Sequence[Approach], seen: Sequence[np.ndarray]) -> float:
    total = sum(
        int(exits.sum()) * float(jensen_shannon(exits / exits.sum(), np.array(fork.shares)))
        for fork, exits in zip(forks, seen, strict=True)
        if exits.sum()
    )
    return float(total / sum(int(exits.sum()) for exits in seen))


def _floor(
    forks: Sequence[Approach], seen: Sequence[np.ndarray], rng: np.random.Generator
) -> float:
    """Mean divergence of a policy that draws from the expert's shares, as often as each approach was passed."""
    total = 0.0
    for fork, exits in zip(forks, seen, strict=True):
        count = int(exits.sum())
        if count:
            shares = np.array(fork.shares)
            drawn = rng.multinomial(count, shares, size=NUM_DRAWS) / count
            total += count * float(
                jensen_shannon(drawn, np.broadcast_to(shares, drawn.shape)).mean()
            )
    return total / sum(int(exits.sum()) for exits in seen)


def _turns(
    forks: Sequence[Approach], seen: Sequence[np.ndarray], moves: Mapping[str, Move]
) -> tuple[Float[np.ndarray, " M"], Float[np.ndarray, " M"]]:
    """How often each `Move` was made, and how often an expert would have made it at the same approaches [-]."""
    made, expected = np.zeros(len(Move)), np.zeros(len(Move))
    for fork, exits in zip(forks, seen, strict=True):
        for name, share, count in zip(fork.exits, fork.shares, exits.tolist(), strict=True):
            made[moves[name]] += count
            expected[moves[name]] += share * exits.sum()
    return made, expected
