"""`mjdrive study`: demonstrations, trained agents, drives, tables, figures and report in one command."""

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

from mjdrive.cli.options import Jobs, chosen_executor, executor_options

if TYPE_CHECKING:
    from mjdrive.study.records.results import StudyResults

STUDIES = Path("studies")


@click.command()
@click.option(
    "--preset",
    default="standard",
    show_default=True,
    metavar="quick|standard|paper",
    help="Minutes (quick), a night on two cores (standard), or the paper's settings throughout (paper, about six days).",
)
@click.option(
    "--methods",
    metavar="NAME,NAME",
    help="Methods to compare, as bc-beta,da-ibc, each with all seeds. [default: as the preset says]",
)
@click.option(
    "--seeds",
    metavar="N,N",
    help="Training seeds, as 0,1,2: an agent for each method and seed. [default: as the preset says]",
)
@click.option("--episodes", type=click.IntRange(min=1), metavar="N", help="Drives of each agent.")
@click.option(
    "--steps", type=click.IntRange(min=1), metavar="N", help="Control steps of 0.1 s of each drive."
)
@click.option(
    "--set",
    "assignments",
    multiple=True,
    metavar="NAME=VALUE",
    help="Change one setting: of the study, as long_steps=0; of all learners, as optimiser.epochs=5; or of one method, "
    "as da-ibc:optimiser.epochs=5. May be given again.",
)
@click.option(
    "--no-ablations", "without_ablations", is_flag=True, help="Compare the methods alone."
)
@click.option(
    "--arms",
    metavar="NAME,NAME",
    help="Ways to act to compare, as da-ibc-committed,bc-beta-mode; methods without any are left out. [default: all of the preset]",
)
@click.option(
    "--data",
    multiple=True,
    metavar="DIR|NAME=DIR",
    help="Demonstrations that are there, instead of collecting them. May be given again for another data set.",
)
@click.option(
    "--runs",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder with trained runs, called as bc-beta-0; what is missing in it is trained.",
)
@executor_options
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="New folder for the study, or one to go on with. [default: studies/<date and time>]",
)
def study(
    *,
    preset: str,
    methods: str | None,
    seeds: str | None,
    episodes: int | None,
    steps: int | None,
    assignments: tuple[str, ...],
    without_ablations: bool,
    arms: str | None,
    data: tuple[str, ...],
    runs: Path | None,
    jobs: Jobs,
    backend: str,
    address: str | None,
    out: Path | None,
) -> None:
    """Compare methods: collect, train each with several seeds, drive, measure, and report.

    An interrupted study can be run again with the same options and --out, and goes on. Each training has as many
    threads as --set threads=N says (1). A cluster trains where it sees the folders of --out and --data; else agents are
    trained here.
    """
    import datetime

    from mjdrive.cli.console import ended_by_sigterm, stage_bars
    from mjdrive.evaluation import report
    from mjdrive.study.settings import overrides  # torch takes a second
    from mjdrive.study.study import Study

    config = overrides.chosen(
        preset,
        methods=None if methods is None else _listed(methods),
        seeds=None if seeds is None else [_number(text) for text in _listed(seeds)],
        episodes=episodes,
        steps=steps,
        assignments=assignments,
        ablations=not without_ablations,
        arms=None if arms is None else _listed(arms),
    )
    folder = out or report.new_folder(STUDIES, datetime.datetime.now())
    work = Study(
        config,
        folder,
        _data_sets(data, config.demonstrations[0].name),
        runs,
        chosen_executor(jobs, backend, address),
        _command(sys.argv),
    )
    with ended_by_sigterm(), stage_bars() as stage:
        results = work.run(stage)
    _close(results, folder, preset)


def _close(results: "StudyResults", folder: Path, preset: str) -> None:
    """Say what there is to look at."""
    from mjdrive.cli.console import closing_table
    from mjdrive.study.records import results as files
    from mjdrive.study.report import report
    from mjdrive.study.tables import tables

    closing_table(
        f"Study, preset {preset}",
        {
            "agents": len({(it.variant, it.seed) for it in results.arms}),
            "ways to act": len({it.arm for it in results.arms}),
            "report": folder / report.REPORT,
            "tables": folder / tables.TABLES,
            "results": folder / files.RESULTS,
            "settings": folder / files.STUDY,
        },
        next_command=f"python -m webbrowser {folder / report.REPORT}",
    )


def _command(arguments: Sequence[str]) -> str:
    """What was typed, for a shell to read again."""
    return shlex.join(["mjdrive", *arguments[1:]])


def _listed(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _number(text: str) -> int:
    if not text.isdecimal():
        raise click.BadParameter(f"'{text}' is no seed; expected whole numbers, as in 0,1,2.")
    return int(text)


def _data_sets(values: tuple[str, ...], first: str) -> dict[str, Path]:
    """Read which folder holds which data set; without a name, the first one of the study."""
    found = {}
    for value in values:
        name, equals, place = value.partition("=")
        found[name if equals else first] = Path(place if equals else value)
    return found
