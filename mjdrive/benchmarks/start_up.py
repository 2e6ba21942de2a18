"""How long the command line takes before it does anything."""

import subprocess
import sys

from mjdrive.benchmarks.comparison import Figure, Plan
from mjdrive.benchmarks.timing import alone

MOST = 0.5
"""What a start may take [s]."""

HEAVY = ("torch", "mujoco")
"""Packages that neither may import."""

_HELP = "import sys; sys.argv = ['mjdrive', '--help']; from mjdrive.cli.main import main; main(standalone_mode=False)"
_IMPORT = "import mjdrive"


def measure(plan: Plan) -> tuple[Figure, ...]:
    """Start the interpreter again and again, and look at what it has imported.

    Args:
        plan: How much to measure.
    """
    return (
        _figure(plan, "mjdrive --help", _HELP),
        _figure(plan, "import mjdrive", _IMPORT),
    )


def _figure(plan: Plan, name: str, program: str) -> Figure:
    loaded = imported_by(program)
    rounds = alone(lambda: _run(program), rounds=plan.rounds(15))
    return Figure(
        name=name,
        work="a new process, from start to end",
        rounds=rounds if not loaded else (float("inf"),),
        unit="s",
        most=MOST,
        note=f"imports {' and '.join(loaded)}, which it must not" if loaded else "",
    )


def imported_by(program: str) -> tuple[str, ...]:
    """Tell which of `HEAVY` a program has imported when it ends."""
    asks = f"{program}; import sys; print(*(name for name in {HEAVY!r} if name in sys.modules))"
    return tuple(_run(asks).splitlines()[-1].split())


def _run(program: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    )
    return done.stdout
