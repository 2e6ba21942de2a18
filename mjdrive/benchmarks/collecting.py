"""The paper's ten routes, collected by the command as a user would, and what they take on the disk."""

import subprocess
import sys
from functools import partial
from pathlib import Path

from mjdrive.benchmarks.comparison import Comparison, Figure, Plan, Reads, Row
from mjdrive.benchmarks.timing import paired
from mjdrive.bev.layers import Layer
from mjdrive.config import BevConfig, SimulationConfig
from mjdrive.episodes import dataset
from mjdrive.errors import WorkerError
from mjdrive.execution.pool import available_cores

TOWN = "town01"
JOBS = 2
FASTER_THAN_REAL_TIME = 100.0
SMALLER_THAN_FRAMES = 500.0
QUICK_ROUTE = ("--routes", "0")


def measure(plan: Plan) -> tuple[Row, ...]:
    """Collect again and again into new folders, start of Python and pictures included.

    Args:
        plan: How much to measure.
    """
    routes = QUICK_ROUTE if plan.quick else ()
    folders = {jobs: plan.workspace / f"collected-{jobs}" for jobs in (JOBS, 1)}
    rounds = paired(
        *(partial(_collect, folder, jobs, routes) for jobs, folder in folders.items()),
        rounds=plan.rounds(3),
        warm_up=0,
    )
    manifest, _ = dataset.read_dataset(folders[JOBS])
    num_steps = sum(entry.steps for entry in manifest.episodes)
    driven = num_steps * SimulationConfig().control_interval
    what = f"{len(manifest.episodes)} routes of {TOWN} as in the paper, {driven:,.0f} s of driving"
    frame = len(Layer) * BevConfig().size_px ** 2
    return (
        Comparison(
            name="collecting",
            work=what,
            ours=f"mjdrive collect --jobs {JOBS}, from start to end",
            theirs="driving in real time",
            our_rounds=rounds.ours,
            their_rounds=(driven,) * len(rounds.ours),
            bar=FASTER_THAN_REAL_TIME,
            piece="data set",
            note=f"Wall time on {available_cores()} cores; both are busy.",
        ),
        Figure(
            name="collecting: gain of a second process",
            work="wall time with --jobs 1 over that with --jobs 2",
            rounds=tuple(one / many for many, one in zip(rounds.ours, rounds.theirs, strict=True)),
            unit="x",
            note="In turns with the row above; starts of Python, which both pay, are in it.",
        ),
        Comparison(
            name="data set on the disk",
            work=what,
            ours="states in a compressed file, views drawn again",
            theirs=f"its {num_steps:,} views of 5 x 192 x 192 as bytes",
            our_rounds=(_size(folders[JOBS]) / 1e6,),
            their_rounds=(num_steps * frame / 1e6,),
            bar=SMALLER_THAN_FRAMES,
            reads=Reads.SMALLER,
            unit="MB",
            piece="data set",
        ),
    )


def _collect(folder: Path, jobs: int, routes: tuple[str, ...]) -> None:
    """Run the command; what it says is shown only if it fails."""
    command = [sys.executable, "-m", "mjdrive", "collect", "--town", TOWN, "--preset", "paper"]
    command += ["--jobs", str(jobs), "--out", str(folder), "--overwrite", *routes]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise WorkerError(
            f"`mjdrive collect` ended with {done.returncode} ({done.stderr.strip().rpartition(chr(10))[2]}). "
            f"Expected demonstrations in '{folder}'."
        )


def _size(folder: Path) -> int:
    """All that `train` reads of a data set [bytes]."""
    pictures = {".png"}
    return sum(
        path.stat().st_size
        for path in folder.rglob("*")
        if path.is_file() and path.suffix not in pictures
    )
