"""What is asked of the MPC expert on top of flawless drives, and what its drives say to that."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from mjdrive.evaluation.expert_drives import SLOW_MS, Drive

Clock = Literal["wall", "cpu"]
"""What times of decisions are judged by."""

MEAN_MS = 20.0
"""A decision takes no longer than this on average [ms]."""

MOST_SLOW = 1.0
"""Of 100 decisions no more take longer than `SLOW_MS`: that is their 99th percentile [-]."""

OFFSET_RMS = 0.25
"""No drive is farther from its route, root mean square [m]."""

SHARE_OF_PID = 0.5
"""The MPC is smoother than the PID by this factor [-]."""


@dataclass(frozen=True, slots=True)
class ExpertBar:
    """A figure of an expert in a town, and what it may be at most.

    Attributes:
        town: Where it drove.
        figure: What was measured.
        measured: Its value, in `unit`.
        most: Largest value that is good enough, in `unit`.
        unit: Such as "m"; empty for a share.
        is_open: Whether it decides nothing: known not to be held, or not to be judged by this clock. docs/experts.md says why.
    """

    town: str
    figure: str
    measured: float
    most: float
    unit: str = ""
    is_open: bool = False

    @property
    def holds(self) -> bool:
        """Whether the figure is small enough."""
        return self.measured <= self.most

    def __str__(self) -> str:
        """In words."""
        unit = f" {self.unit}" if self.unit else ""
        return f"mpc {self.town}: {self.figure} {self.measured:.3g}{unit}; expected at most {self.most:.3g}{unit}"


def bars(drives: Sequence[Drive], *, clock: Clock = "wall") -> tuple[ExpertBar, ...]:
    """Hold the drives of the MPC to its bars, town by town; drives that did not arrive say nothing.

    Args:
        drives: Of any experts. Without those of the PID on the same routes and seeds, smoothness is not compared.
        clock: Whether the clock decides how long decisions took, or CPU time alone, which a busy machine does not spoil.
    """
    by_cpu = clock == "cpu"
    arrived = [it for it in drives if it.steps]
    found: list[ExpertBar] = []
    for town in dict.fromkeys(it.town for it in arrived if it.expert == "mpc"):
        own = [it for it in arrived if (it.expert, it.town) == ("mpc", town)]
        found += [
            ExpertBar(town, "mean time of a decision", mean_ms(own), MEAN_MS, "ms", by_cpu),
            ExpertBar(town, "decisions over 50 ms, of 100", 100 * slow_share(own), MOST_SLOW, "", by_cpu),
            ExpertBar(town, "mean CPU time of a decision", mean_cpu_ms(own), MEAN_MS, "ms"),
            ExpertBar(town, "99th percentile of CPU time, worst drive", max(it.cpu.p99_ms for it in own), SLOW_MS, "ms"),
            ExpertBar(town, "lane error of a drive, RMS", max(it.offset_rms_m for it in own), OFFSET_RMS, "m"),
        ]  # fmt: skip
        found += _beside_pid(town, own, [it for it in arrived if it.expert == "pid"])
    return tuple(found)


def _beside_pid(town: str, own: Sequence[Drive], others: Sequence[Drive]) -> list[ExpertBar]:
    """Smoothness beside the PID's on the same routes under the same lights."""
    twins = {(it.town, it.route, it.seed): it for it in others}
    pairs = [(it, twins.get((it.town, it.route, it.seed))) for it in own]
    mine = [it for it, twin in pairs if twin is not None]
    pids = [twin for _, twin in pairs if twin is not None]
    if not mine:
        return []
    jerk = rms(mine, lambda it: it.jerk_rms) / rms(pids, lambda it: it.jerk_rms)
    whiteness = rms(mine, lambda it: it.steering_whiteness) / rms(
        pids, lambda it: it.steering_whiteness
    )
    unrest = rms(mine, lambda it: it.steering_unrest) / rms(pids, lambda it: it.steering_unrest)
    return [
        ExpertBar(town, "jerk, of the PID's", jerk, SHARE_OF_PID),
        ExpertBar(town, "steering unrest, of the PID's", unrest, SHARE_OF_PID),
        ExpertBar(town, "steering whiteness, of the PID's", whiteness, SHARE_OF_PID, is_open=True),
    ]


def rms(drives: Sequence[Drive], figure: Callable[[Drive], float]) -> float:
    """Root mean square over all steps of some drives, in the unit of the figure.

    Args:
        drives: At least one of them arrived.
        figure: Root mean square of one drive.
    """
    squares = sum(it.steps * figure(it) ** 2 for it in drives)
    return math.sqrt(squares / sum(it.steps for it in drives))


def mean_ms(drives: Sequence[Drive]) -> float:
    """Mean time of a decision by the clock [ms]."""
    return sum(it.steps * it.wall.mean_ms for it in drives) / sum(it.steps for it in drives)


def mean_cpu_ms(drives: Sequence[Drive]) -> float:
    """Mean CPU time of a decision [ms]."""
    return sum(it.steps * it.cpu.mean_ms for it in drives) / sum(it.steps for it in drives)


def slow_share(drives: Sequence[Drive]) -> float:
    """Share of decisions that took longer than `SLOW_MS` by the clock [-]."""
    return sum(it.wall.slow for it in drives) / sum(it.steps for it in drives)
