"""Options that several commands share."""

from pathlib import Path

import rich_click as click

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
