"""How the solves of an expert ended: counted while it drives, told of each drive."""

import json
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

SOLVER, SOLVES = "solver", "solves"
"""Under these names `Episode.metadata` holds who solved, and as JSON how often which way it ended."""

OUTCOMES = ("solved", "max_iterations", "failed", "recoveries", "hard_stops")
"""Counts that are the same on every machine, so that files may hold them."""


@dataclass
class SolveCounts:
    """How the solves of an expert have ended since it was made.

    Attributes:
        solved: Plans found [-].
        max_iterations: Solves that were given up at the limit of iterations [-].
        failed: Solves that ended without a plan [-].
        recoveries: Decisions that were left to the PID without a solve, because something had pushed the car [-].
        hard_stops: Decisions that were left to the PID, because a light came too late for a smooth plan [-].
        late: Plans that came late: deciding took longer than `MpcConfig.late_after` [-]; hangs on the machine.
        times: CPU time of each solve [s].
    """

    solved: int = 0
    max_iterations: int = 0
    failed: int = 0
    recoveries: int = 0
    hard_stops: int = 0
    late: int = 0
    times: list[float] = field(default_factory=list)

    def outcomes(self) -> dict[str, int]:
        """The counts named in `OUTCOMES` [-]."""
        return {name: getattr(self, name) for name in OUTCOMES}


@runtime_checkable
class SolvingExpert(Protocol):
    """An expert that solves a problem for its decisions.

    Attributes:
        solver_name: Name of the solver in use.
        solves: How its solves have ended since it was made.
    """

    solver_name: str
    solves: SolveCounts


class SolveWatch:
    """Counts the solves of one drive, which begins now.

    Args:
        expert: Who drives; of one that solves nothing there is nothing to tell.
    """

    def __init__(self, expert: object) -> None:
        self._expert = expert if isinstance(expert, SolvingExpert) else None
        self._before = self._counts().outcomes()
        self._late_before = self._counts().late

    @property
    def late(self) -> int:
        """Plans that came late [-]; another figure on another machine, so no file holds it."""
        return self._counts().late - self._late_before

    def metadata(self) -> dict[str, str]:
        """What an episode says of its solves."""
        if self._expert is None:
            return {}
        now = self._counts().outcomes()
        solves = {name: now[name] - self._before[name] for name in OUTCOMES}
        return {SOLVER: self._expert.solver_name, SOLVES: json.dumps(solves)}

    def _counts(self) -> SolveCounts:
        return SolveCounts() if self._expert is None else self._expert.solves
