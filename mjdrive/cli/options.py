"""Options that several commands share."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import rich_click as click

if TYPE_CHECKING:
    from mjdrive.execution.work import Executor

Command = TypeVar("Command", bound=Callable[..., Any])
Jobs = int | Literal["auto"] | None
"""Value of --jobs: None if it was not given [-]."""

car_option = click.option(
    "--car",
    "car_name",
    default="default",
    show_default=True,
    metavar="NAME|FILE.xml",
    help="A car that comes with mjdrive (default, mkz), or an MJCF file of your own.",
)
"""Which car drives."""

gains_option = click.option(
    "--gains",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Settings of the expert that `mjdrive tune` found for this car.",
)
"""Settings that an expert was tuned to."""


def _read_jobs(ctx: click.Context, param: click.Parameter, value: str | None) -> Jobs:
    """Read a number of at least 1, or "auto"."""
    if value is None:
        return None
    if value == "auto":
        return "auto"
    try:
        jobs = int(value)
    except ValueError as error:
        raise click.BadParameter(
            f"'{value}' is no number; expected one of at least 1, or auto."
        ) from error
    if jobs < 1:
        raise click.BadParameter(f"{jobs} is too small; expected at least 1, or auto.")
    return jobs


def executor_options(command: Command) -> Command:
    """Give a command --jobs, --backend and --address; `chosen_executor` takes all three."""
    for option in (
        click.option(
            "--address",
            metavar="HOST:PORT",
            help="Head of the Ray cluster. [default: the one that this machine is part of]",
        ),
        click.option(
            "--backend",
            default="local",
            show_default=True,
            metavar="local|ray|slurm",
            help="Where it is done: in processes of this machine, on a Ray cluster that runs, or on Slurm.",
        ),
        click.option(
            "--jobs",
            callback=_read_jobs,
            metavar="N|auto",
            help="Drives or trainings at once; the files are the same. auto: one a core of this machine, or what the cluster takes. "
            "[default: 1 here, auto on a cluster]",
        ),
    ):
        command = option(command)
    return command


def chosen_executor(jobs: Jobs, backend: str, address: str | None) -> "Executor":
    """Make the executor that a user asks for; more processes than cores are made, with a note.

    Args:
        jobs: Value of --jobs [-].
        backend: Value of --backend.
        address: Value of --address.

    Raises:
        ClusterError: If there is no such cluster.
        ConfigError: If the address has no effect.
        MissingPackageError: If the package for a cluster is not installed.
        UnknownNameError: If there is no such backend.
    """
    from mjdrive.execution.executors import executor_for
    from mjdrive.execution.pool import available_cores

    if jobs is None:
        jobs = 1 if backend == "local" else "auto"
    cores = available_cores()
    if backend == "local" and jobs != "auto" and jobs > cores:
        there = "1 core that there is" if cores == 1 else f"{cores} cores that there are"
        click.echo(
            f"--jobs {jobs} is more than the {there} for mjdrive here: processes will wait for each other, and each takes "
            f"its memory. --jobs auto takes {cores}.",
            err=True,
        )
    return executor_for(jobs=None if jobs == "auto" else jobs, backend=backend, address=address)
