"""Peak memory of training on as many samples as the study has, measured in a process that does nothing else."""

import resource
import subprocess
import sys
from pathlib import Path

from mjdrive.benchmarks import carried
from mjdrive.benchmarks.comparison import Figure, Plan, Row
from mjdrive.errors import WorkerError
from mjdrive.learning.settings import learner_settings
from mjdrive.learning.training import train

NUM_SAMPLES = 21_287
"""Samples of the study [-]."""

MOST_GB = 3.0
QUICK_SAMPLES = 1000
"""Samples for a quick look [-]."""

METHODS = ("da-ibc", "bc-beta")


def measure(plan: Plan) -> tuple[Row, ...]:
    """Train both methods with the paper's settings for an epoch, each in a process of its own.

    Args:
        plan: How much to measure.
    """
    num = QUICK_SAMPLES if plan.quick else NUM_SAMPLES
    data = plan.workspace / f"carried-{num}"
    plan.on_stage(f"data set of {num} samples")
    carried.write_dataset(data, num)
    rows = []
    for method in METHODS if not plan.quick else METHODS[:1]:
        plan.on_stage(f"{method}, {num} samples")
        peak = peak_of_training(method, data, plan.workspace / f"memory-{method}")
        rows.append(
            Figure(
                name=f"memory of training, {method}",
                work=f"an epoch of `mjdrive train {method} --preset paper` on {num} samples",
                rounds=(peak / 1e9,),
                unit="GB",
                most=MOST_GB,
                note="Largest resident set of the process; it reads the data set, draws all views, trains and writes "
                "its checkpoint. The car of the data set was carried along random ways, not driven.",
            )
        )
    return tuple(rows)


def peak_of_training(method: str, data: Path, run: Path) -> int:
    """Train for an epoch in a process of its own and tell its peak [bytes].

    Args:
        method: "da-ibc" or "bc-beta".
        data: Data set.
        run: Folder for the run; one that is in it is replaced.

    Raises:
        WorkerError: If the process fails.
    """
    command = [sys.executable, "-m", __name__, method, str(data), str(run)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise WorkerError(
            f"Training {method} to measure its memory ended with {done.returncode} "
            f"({done.stderr.strip().rpartition(chr(10))[2]}). Expected an epoch on '{data}'; `mjdrive train {method} "
            f"--data {data}` should work."
        )
    return int(done.stdout)


def peak_bytes() -> int:
    """Largest resident set of this process so far [bytes]."""
    status = Path("/proc/self/status")
    if status.is_file():  # getrusage also counts what the process was forked from
        lines = status.read_text().splitlines()
        (peak,) = (line for line in lines if line.startswith("VmHWM:"))
        return 1024 * int(peak.split()[1])
    peak_rss = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak_rss if sys.platform == "darwin" else 1024 * peak_rss


def main() -> None:
    """Train a method on a data set into a folder, as the three arguments say, and print the peak [bytes]."""
    method, data, run = sys.argv[1:]
    config = learner_settings(method, preset="paper", assignments=["optimiser.epochs=1"])
    train(config, data=Path(data), run=Path(run), seed=0, overwrite=True, device="cpu")
    print(peak_bytes())  # noqa: T201  (that is the answer)


if __name__ == "__main__":
    main()
