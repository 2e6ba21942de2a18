"""`mjdrive bench`: measure how fast everything is, beside what else one might use."""

from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

from mjdrive.errors import ConfigError

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

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
    help="Write machine, versions and every round to this file, as soon as each benchmark has ended.",
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
    if results is not None:
        _refuse_beside_results(names=names, quick=quick, rivals=rivals)
    earlier = read_json(Report, results) if results else None
    if markdown is not None:
        _require_page(markdown, [it.name for it in chosen] if earlier is None else earlier.rows)
    report = earlier or _measured(chosen, quick=quick, rivals=rivals, out=out)
    written: list[Path] = []
    if out is not None:
        write_json(report, out)
        written.append(out)
    if markdown is not None:
        from mjdrive.benchmarks.results_page import write_page

        written += write_page(report, markdown)
    report_table(report, written)


def _refuse_beside_results(*, names: tuple[str, ...], quick: bool, rivals: Path | None) -> None:
    """Refuse what would have no effect, because nothing is measured."""
    given = {"--only": bool(names), "--quick": quick, "--rivals": rivals is not None}
    without_effect = ", ".join(option for option, is_given in given.items() if is_given)
    if without_effect:
        raise ConfigError(
            f"{without_effect} has no effect with --results, which measures nothing. Leave out one or the other."
        )


def _require_page(page: Path, names: "Collection[str]") -> None:
    """Refuse a page without marks, and a table that lacks benchmarks: it would replace the whole one."""
    from mjdrive.benchmarks.results_page import around_results
    from mjdrive.benchmarks.suite import SUITE

    missing = [benchmark.name for benchmark in SUITE if benchmark.name not in names]
    if missing:
        raise ConfigError(
            f"--markdown {page} would lose the rows of {', '.join(missing)}; expected results of all benchmarks. Leave out "
            f"--markdown to see the rows here, or --only to measure all."
        )
    around_results(page)


def _measured(
    benchmarks: "Sequence[Benchmark]", *, quick: bool, rivals: Path | None, out: Path | None
) -> "Report":
    """Run benchmarks in a folder that is gone afterwards, behind a bar; what is measured is kept at once."""
    import tempfile

    from mjdrive.benchmarks.comparison import Plan
    from mjdrive.benchmarks.suite import run
    from mjdrive.cli.console import ended_by_sigterm, progress_bars
    from mjdrive.config import write_json
    from models import hardware

    def keep(report: "Report") -> None:
        if out is not None:
            write_json(report, out)

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
        report = run(benchmarks, plan, networks=hardware.describe(), on_begin=begin, on_report=keep)
        bars.update(task, description="bench", completed=len(benchmarks))
    return report
