"""The paper's ten routes, collected by the command as a user would, and what they take on the disk."""

import subprocess
import sys
from pathlib import Path

from mjdrive.benchmarks.comparison import Comparison, Plan, Reads
from mjdrive.benchmarks.timing import timed
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


def measure(plan: Plan) -> tuple[Comparison, ...]:
    """Collect again and again into new folders, start of Python and pictures included.

    Args:
        plan: How much to measure.
    """
    folders = [plan.workspace / f"collected-{number}" for number in range(plan.rounds(3))]
    routes = QUICK_ROUTE if plan.quick else ()
    seconds = tuple(timed(lambda folder=folder: _collect(folder, routes)) for folder in folders)  # type: ignore[misc]
    manifest, _ = dataset.read_dataset(folders[0])
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
            our_rounds=seconds,
            their_rounds=(driven,) * len(seconds),
            bar=FASTER_THAN_REAL_TIME,
            piece="data set",
            note=f"Wall time on {available_cores()} cores; both are busy.",
        ),
        Comparison(
            name="data set on the disk",
            work=what,
            ours="states in a compressed file, views drawn again",
            theirs=f"its {num_steps:,} views of 5 x 192 x 192 as bytes",
            our_rounds=(_size(folders[0]) / 1e6,),
            their_rounds=(num_steps * frame / 1e6,),
            bar=SMALLER_THAN_FRAMES,
            reads=Reads.SMALLER,
            unit="MB",
            piece="data set",
        ),
    )


def _collect(folder: Path, routes: tuple[str, ...]) -> None:
    """Run the command; what it says is shown only if it fails."""
    command = [sys.executable, "-m", "mjdrive", "collect", "--town", TOWN, "--preset", "paper"]
    command += ["--jobs", str(JOBS), "--out", str(folder), *routes]
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
