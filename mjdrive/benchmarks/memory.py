"""Peak memory of training on as many samples as the study has, measured in a process that does nothing else."""

import resource
import subprocess
import sys
from pathlib import Path

from mjdrive.benchmarks.comparison import Figure, Plan, Row

NUM_SAMPLES = 21_287
"""Samples of the study [-]."""

MOST_GB = 3.0
STEPS = 12
"""Steps after which memory no longer grows [-]."""

METHODS = ("da-ibc", "bc-beta")


def measure(plan: Plan) -> tuple[Row, ...]:
    """Train both methods with the paper's settings for a few steps, each in a process of its own.

    Args:
        plan: How much to measure.
    """
    rows = []
    for method in METHODS if not plan.quick else METHODS[:1]:
        plan.on_stage(f"{method}, {NUM_SAMPLES} samples")
        answer = subprocess.run(
            [sys.executable, "-m", __name__, method], capture_output=True, text=True, check=True
        )
        rows.append(
            Figure(
                name=f"memory of training, {method}",
                work=f"peak of `mjdrive train {method} --preset paper` on {NUM_SAMPLES} samples, {STEPS} steps",
                rounds=(float(answer.stdout) / 1e9,),
                unit="GB",
                most=MOST_GB,
                note="Largest resident set of the process, drawing of all views included.",
            )
        )
    return tuple(rows)


def peak_bytes() -> int:
    """Largest resident set of this process so far [bytes]."""
    status = Path("/proc/self/status")
    if status.is_file():  # getrusage also counts what the process was forked from
        lines = status.read_text().splitlines()
        (peak,) = (line for line in lines if line.startswith("VmHWM:"))
        return 1024 * int(peak.split()[1])
    peak_rss = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak_rss if sys.platform == "darwin" else 1024 * peak_rss


class _EnoughError(Exception):
    """A few steps are done."""


def main() -> None:
    """Train the method of the first argument for a few steps and print the peak [bytes]."""
    # The process that measures needs no torch.
    from mjdrive.benchmarks.carried import demonstrations  # noqa: PLC0415
    from models import presets  # noqa: PLC0415
    from models.learners import build_learner  # noqa: PLC0415
    from models.progress import StepReport  # noqa: PLC0415
    from models.training import fit  # noqa: PLC0415

    def stop(report: StepReport) -> None:
        if report.step == STEPS:
            raise _EnoughError

    config = presets.preset("paper", sys.argv[1])
    learner = build_learner(config, seed=0)
    try:
        fit(learner, demonstrations(NUM_SAMPLES), config, on_step=stop)
    except _EnoughError:
        print(peak_bytes())  # noqa: T201  (that is the answer)


if __name__ == "__main__":
    main()
