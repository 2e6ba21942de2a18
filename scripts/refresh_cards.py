"""Write the commands and pages of the shipped policies again: after presets, wording or, with --drive, physics changed.

Weights, training and evaluations stay what they are.

Example: python scripts/refresh_cards.py --drive
"""

from pathlib import Path

import click

from mjdrive.cli.console import stages
from mjdrive.cli.main import Script
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.zoo import entries
from mjdrive.zoo.reference import TOWN
from mjdrive.zoo.shipping import refresh


@click.command(cls=Script)
@click.option("--drive", "drives", is_flag=True, help="Make the reference drives again, too.")
@click.option(
    "--zoo",
    type=click.Path(path_type=Path),
    default=entries.FOLDER,
    help="Folder of the entries. [default: models/zoo]",
)
def main(*, drives: bool, zoo: Path) -> None:
    """Write model cards again."""
    simulation = Simulation(library.load(TOWN)) if drives else None
    names = entries.names(zoo)
    with stages("refresh cards", len(names)) as on_stage:
        for name in names:
            on_stage(name)
            refresh(zoo / name, simulation=simulation)


if __name__ == "__main__":
    main()
