"""All benchmarks by name, and a run of some of them."""

import importlib
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from mjdrive.benchmarks import machine
from mjdrive.benchmarks.comparison import NotMeasured, Plan, Row
from mjdrive.benchmarks.machine import Machine
from mjdrive.errors import MjdriveError, UnknownNameError


@dataclass(frozen=True, slots=True)
class Benchmark:
    """One entry of the suite, which may give several rows.

    Attributes:
        name: What `--only` takes.
        work: What is measured.
        entry: Where it is: module of this package, colon, function from a `Plan` to rows. It is imported when it runs.
    """

    name: str
    work: str
    entry: str

    def measure(self, plan: Plan) -> tuple[Row, ...]:
        """Measure it; a mistake that the user can mend gives a row that tells it, and costs no other row."""
        try:
            return self._rows(plan)
        except MjdriveError as error:
            again = f"that, and then: mjdrive bench --only {self.name}"
            return (NotMeasured(self.name, self.work, str(error), again),)

    def _rows(self, plan: Plan) -> tuple[Row, ...]:
        module, _, function = self.entry.partition(":")
        found = getattr(importlib.import_module(f"{__package__}.{module}"), function)
        return tuple(found(plan))


SUITE = (
    Benchmark("start", "`mjdrive --help` and `import mjdrive`", "start_up:measure"),
    Benchmark("step", "a control step against its physics alone", "simulation_step:measure"),
    Benchmark("bev", "the bird's-eye view, a frame", "bev:measure"),
    Benchmark("metadrive-84", "MetaDrive, view of 84 x 84 x 5", "rivals:metadrive_84"),
    Benchmark("metadrive-192", "MetaDrive, view of 192 x 192 x 5", "rivals:metadrive_192"),
    Benchmark("car-racing", "Gymnasium's CarRacing", "rivals:car_racing"),
    Benchmark("intersection", "highway-env's intersection", "rivals:intersection"),
    Benchmark(
        "collect", "the paper's ten routes: time, and size on the disk", "collecting:measure"
    ),
    Benchmark("dfo", "a decision by the paper's search", "dfo:measure"),
    Benchmark("grid", "a decision by the exact softmax on a grid", "grid:measure"),
    Benchmark("train", "a training step of DA-IBC and of BC-Beta", "training:measure"),
    Benchmark("memory", "peak memory of training on 21,287 samples", "memory:measure"),
    Benchmark("drive", "3000 steps of driving with a policy", "closed_loop:measure"),
    Benchmark("serve", "what pages that watch cost `mjdrive serve`", "watching:measure"),
)
"""In the order of the table."""


@dataclass(frozen=True, slots=True)
class Report:
    """What one run of the suite found.

    Attributes:
        machine: Where.
        is_quick: Whether it was only a look.
        rows: Of each benchmark, by its name.
        seconds: What each benchmark took, by its name [s].
        others: How many cores other programs kept busy meanwhile, by its name; -1 where it is not known [-].
    """

    machine: Machine
    is_quick: bool
    rows: dict[str, tuple[Row, ...]]
    seconds: dict[str, float]
    others: dict[str, float] = field(default_factory=dict)

    @property
    def all_rows(self) -> tuple[Row, ...]:
        """The rows of all benchmarks in order."""
        return tuple(row for rows in self.rows.values() for row in rows)

    @property
    def neighbours(self) -> str:
        """What other programs took of the machine, in a sentence; empty where it is not known."""
        known = [name for name, cores in self.others.items() if cores >= 0.0]
        if not known:
            return ""
        seconds = sum(self.seconds[name] for name in known)
        mean = sum(self.others[name] * self.seconds[name] for name in known) / seconds
        worst = max(known, key=self.others.__getitem__)
        return (
            f"Other programs kept {mean:.2f} of {self.machine.num_cores} cores busy meanwhile, "
            f"{self.others[worst]:.2f} at the most (during '{worst}')."
        )


def choose(names: Sequence[str]) -> tuple[Benchmark, ...]:
    """Find benchmarks by name; all of them if none is named.

    Raises:
        UnknownNameError: If there is no such benchmark.
    """
    known = {benchmark.name: benchmark for benchmark in SUITE}
    for name in names:
        if name not in known:
            raise UnknownNameError("benchmark", name, known)
    return tuple(benchmark for benchmark in SUITE if not names or benchmark.name in names)


def run(
    benchmarks: Sequence[Benchmark],
    plan: Plan,
    *,
    networks: Mapping[str, str] | None = None,
    on_begin: Callable[[str], None] = lambda name: None,
    on_report: Callable[[Report], None] = lambda report: None,
) -> Report:
    """Measure one benchmark after the other.

    Args:
        benchmarks: Which.
        plan: How much, and where things are.
        networks: What networks find on this machine, for the report.
        on_begin: Told the name of each when it begins.
        on_report: Given all rows so far when one has ended, to be kept whatever comes next.
    """
    where = replace(machine.describe(), networks=dict(networks or {}))
    report = Report(where, plan.quick, {}, {})
    for benchmark in benchmarks:
        on_begin(benchmark.name)
        begin, neighbours = time.monotonic(), machine.Neighbours()
        rows = report.rows | {benchmark.name: benchmark.measure(plan)}
        seconds = report.seconds | {benchmark.name: time.monotonic() - begin}
        others = report.others | {benchmark.name: round(neighbours.cores(), 3)}
        report = Report(where, plan.quick, rows, seconds, others)
        on_report(report)
    return report
