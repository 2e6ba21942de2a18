"""`mjdrive bench`: measure how fast everything is, beside what else one might use."""

from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mjdrive.benchmarks.suite import Benchmark, Report


@click.command()
@click.option(
    "--only",
    "names",
    multiple=True,
    metavar="NAME",
    help="Measure this alone. May be given again; --list tells the names.",
)
@click.option("--list", "is_list", is_flag=True, help="Tell what can be measured, and end.")
@click.option("--quick", is_flag=True, help="Few rounds: a look, no figures to be quoted.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE.json",
    help="Write machine, versions and every round to this file.",
)
@click.option(
    "--markdown",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE.md",
    help="Write the results into this file, between its two marks, and a picture beside it in docs/.",
)
@click.option(
    "--results",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE.json",
    help="Measure nothing: show what an earlier run wrote with --out.",
)
@click.option(
    "--rivals",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Environments that scripts/bench/install_rivals.py made. [default: .rivals of the checkout]",
)
def bench(
    *,
    names: tuple[str, ...],
    is_list: bool,
    quick: bool,
    out: Path | None,
    markdown: Path | None,
    results: Path | None,
    rivals: Path | None,
) -> None:
    """Measure how fast mjdrive is beside what else one might use.

    Every ratio is that of two ways of the same work, run in turns. Takes about a quarter of an hour; close other
    programs first.
    """
    from mjdrive.benchmarks.suite import Report, choose
    from mjdrive.cli.bench_table import names_table, report_table
    from mjdrive.config import read_json, write_json

    if is_list:
        names_table()
        return
    chosen = choose(names)
    report = (
        read_json(Report, results) if results else _measured(chosen, quick=quick, rivals=rivals)
    )
    written: list[Path] = []
    if out is not None:
        write_json(report, out)
        written.append(out)
    if markdown is not None:
        from mjdrive.benchmarks.results_page import write_page

        written += write_page(report, markdown)
    report_table(report, written)


def _measured(benchmarks: "Sequence[Benchmark]", *, quick: bool, rivals: Path | None) -> "Report":
    """Run benchmarks in a folder that is gone afterwards, behind a bar."""
    import tempfile

    from mjdrive.benchmarks.comparison import Plan
    from mjdrive.benchmarks.suite import run
    from mjdrive.cli.console import ended_by_sigterm, progress_bars

    with (
        ended_by_sigterm(),
        tempfile.TemporaryDirectory(prefix="mjdrive-bench-") as folder,
        progress_bars() as bars,
    ):
        task = bars.add_task("bench", total=len(benchmarks), unit="benchmarks")
        names: list[str] = []

        def begin(name: str) -> None:
            bars.update(task, description=name, completed=len(names))
            names.append(name)

        def go_on(stage: str) -> None:
            bars.update(task, description=f"{names[-1]}: {stage}")

        plan = Plan(Path(folder), quick=quick, rivals=rivals, on_stage=go_on)
        report = run(benchmarks, plan, on_begin=begin)
        bars.update(task, description="bench", completed=len(benchmarks))
    return report
