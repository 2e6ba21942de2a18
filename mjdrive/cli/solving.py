"""Who solves for the MPC expert, and how that went: options of the commands, rows of their tables."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import rich_click as click

Command = TypeVar("Command", bound=Callable[..., Any])

_WORDS = {
    "solved": "solved",
    "max_iterations": "out of iterations",
    "failed": "failed",
    "recoveries": "left to the PID after a push",
    "hard_stops": "left to the PID at a late light",
}


def solver_options(command: Command) -> Command:
    """Give a command --solver, --fallback-solver and --late-plan."""
    command = click.option(
        "--late-plan",
        type=click.Choice(["plan", "pid"]),
        help="What the MPC expert drives when deciding took over 50 ms of CPU time: its plan all the same, or what the PID "
        "wants, and then the drive hangs on how fast the machine is. [default: plan]",
    )(command)
    command = click.option(
        "--fallback-solver",
        metavar="NAME",
        help="Solver to take where casadi lacks the first. [default: refuse to drive]",
    )(command)
    return click.option(
        "--solver",
        metavar="NAME",
        help="Who solves for the MPC expert: fatrop, ipopt, or sqpmethod+ osqp, qrqp or piqp. [default: fatrop]",
    )(command)


def solve_rows(solvers: Iterable[str], solves: Iterable[Mapping[str, int]]) -> dict[str, str]:
    """Sum up solves for a closing table; no rows if nothing was solved.

    Args:
        solvers: Name of the solver of each drive, empty if its expert solves nothing.
        solves: How often the solves of each drive ended in which way [-].
    """
    names = sorted({name for name in solvers if name})
    if not names:
        return {}
    total: Counter[str] = Counter()
    for counts in solves:
        total.update(counts)
    told = [
        f"{total[name]:,} {words}"
        for name, words in _WORDS.items()
        if total[name] or name in {"solved", "failed"}
    ]
    return {"solver": ", ".join(names), "solves": ", ".join(told)}


def late_row(late: int, late_after: float, late_plan: str) -> dict[str, str]:
    """Say how many plans came late, which hangs on the machine.

    Args:
        late: Their number [-].
        late_after: What is late [s].
        late_plan: What was driven then, "plan" or "pid".
    """
    met = ", and were left to the PID" if late_plan == "pid" else ""
    return {
        "late plans": f"{late:,} decisions took over {1000 * late_after:g} ms of CPU time here{met}"
    }
