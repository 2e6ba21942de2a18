"""The `mjdrive` command."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import rich_click as click

import mjdrive
from mjdrive.cli.bench import bench
from mjdrive.cli.car import car
from mjdrive.cli.collect import collect
from mjdrive.cli.drive import drive
from mjdrive.cli.export import export
from mjdrive.cli.importing import import_
from mjdrive.cli.info import info
from mjdrive.cli.replay import replay
from mjdrive.cli.serve import serve
from mjdrive.cli.study import study
from mjdrive.cli.towns import towns
from mjdrive.cli.train import train
from mjdrive.cli.tune import tune
from mjdrive.cli.view import view
from mjdrive.errors import MjdriveError

EXIT_MISTAKE = 2
EXIT_INTERRUPTED = 130
"""128 + SIGINT, as shells expect it."""

HELP = """Learn multimodal driving behaviour in MuJoCo towns.

The whole study in three lines:

\b
    mjdrive collect --town town01
    mjdrive train da-ibc
    mjdrive drive --town town02 --steps 3000
"""


class MjdriveGroup(click.RichGroup):
    """A group of commands that tells mistakes and Ctrl-C apart from defects."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the chosen command; a mistake that the user can mend is told in one line."""
        with _mistakes_in_one_line(ctx):
            return super().invoke(ctx)


class Script(click.RichCommand):
    """A command of its own, as those in scripts/, that tells them apart in the same way."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run it; a mistake that the user can mend is told in one line."""
        with _mistakes_in_one_line(ctx):
            return super().invoke(ctx)


@contextmanager
def _mistakes_in_one_line(ctx: click.Context) -> Iterator[None]:
    try:
        yield
    except MjdriveError as error:
        click.echo(f"Error: {' '.join(str(error).split())}", err=True)
        ctx.exit(EXIT_MISTAKE)
    except OSError as error:
        # A folder that cannot be made or written to is the user's to mend.
        click.echo(f"Error: {error}. Expected a place that can be written to.", err=True)
        ctx.exit(EXIT_MISTAKE)
    except KeyboardInterrupt:
        # Every file is written whole or not at all, so there is nothing to clean up.
        click.echo(
            "\nInterrupted. Files are whole: `collect` goes on when it is run again without --overwrite, "
            "`train` with --resume.",
            err=True,
        )
        ctx.exit(EXIT_INTERRUPTED)


@click.group(cls=MjdriveGroup, help=HELP, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(mjdrive.__version__, prog_name="mjdrive")
def main() -> None:
    """Run `mjdrive`."""


for command in (
    collect,
    train,
    drive,
    serve,
    replay,
    export,
    import_,
    view,
    study,
    tune,
    towns,
    car,
    bench,
    info,
):
    main.add_command(command)
