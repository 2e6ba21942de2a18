"""The `mjdrive` command."""

from typing import Any, NoReturn

import rich_click as click

import mjdrive
from mjdrive.cli.collect import collect
from mjdrive.cli.drive import drive
from mjdrive.cli.train import train
from mjdrive.errors import MjdriveError

EXIT_MISTAKE = 2
EXIT_INTERRUPTED = 130
"""128 + SIGINT, as shells expect it."""


class ErrorLine(click.ClickException):
    """A mistake of the user, shown in one line."""

    exit_code = EXIT_MISTAKE

    def show(self, file: Any = None) -> None:
        """Print the message to stderr as it is, without a box around it."""
        click.echo(f"Error: {self.message}", file=file, err=True)


class MjdriveGroup(click.RichGroup):
    """A group of commands that tells mistakes and Ctrl-C apart from defects."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the chosen command.

        Raises:
            ErrorLine: If the user has to mend something.
        """
        try:
            return super().invoke(ctx)
        except MjdriveError as error:
            raise ErrorLine(" ".join(str(error).split())) from error
        except KeyboardInterrupt:
            _stop(ctx)


def _stop(ctx: click.Context) -> NoReturn:
    """Leave after Ctrl-C; every file is written whole or not at all, so there is nothing to clean up."""
    click.echo("\nInterrupted. What is finished is kept; run the same command to go on.", err=True)
    ctx.exit(EXIT_INTERRUPTED)


@click.group(cls=MjdriveGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(mjdrive.__version__, prog_name="mjdrive")
def main() -> None:
    r"""Learn multimodal driving behaviour in MuJoCo towns.

    The whole study in three lines:

    \b
        mjdrive collect --town town01
        mjdrive train da-ibc
        mjdrive drive --town town02 --steps 3000
    """


for command in (collect, train, drive):
    main.add_command(command)
