"""Write the commands and pages of the shipped policies again: after presets, wording or, with --drive, physics changed.

With --evaluation, an entry gets the figures of other drives, too. Weights and training stay what they are.

Example: python scripts/refresh_cards.py --drive
Example: python scripts/refresh_cards.py --evaluation zoo:flow drives/flow
"""

import dataclasses
from collections.abc import Iterable
from pathlib import Path

import click

from mjdrive.cli.console import stages
from mjdrive.cli.main import Script
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.zoo import entries
from mjdrive.zoo.cards import Evaluation, read_card
from mjdrive.zoo.evaluations import read_evaluation
from mjdrive.zoo.reference import TOWN
from mjdrive.zoo.shipping import refresh, write_card
from models import checkpoint


def evaluations_of(
    name: str, folders: Iterable[Path], *, zoo: Path = entries.FOLDER
) -> tuple[Evaluation, ...]:
    """What folders of drives say of an entry, which is named as zoo:flow.

    Raises:
        UnknownNameError: If there is no such entry.
        DataError: If the drives are not those of the entry as it is shipped.
    """
    entry = entries.find(name, zoo)
    weights = read_card(entry).weights
    return tuple(
        read_evaluation(
            folder,
            name=entry.name,
            acting=checkpoint.load_config(entry),
            digests={weights.sha256, weights.trained_sha256},
        )
        for folder in folders
    )


@click.command(cls=Script)
@click.option("--drive", "drives", is_flag=True, help="Make the reference drives again, too.")
@click.option(
    "--evaluation",
    "evaluations",
    multiple=True,
    type=(str, click.Path(path_type=Path)),
    metavar="NAME DIR",
    help="Drives of an entry that replace those of its card; may be given again.",
)
@click.option(
    "--zoo",
    type=click.Path(path_type=Path),
    default=entries.FOLDER,
    help="Folder of the entries. [default: models/zoo]",
)
def main(*, drives: bool, evaluations: tuple[tuple[str, Path], ...], zoo: Path) -> None:
    """Write model cards again."""
    read = {
        name: evaluations_of(name, [folder for it, folder in evaluations if it == name], zoo=zoo)
        for name in dict.fromkeys(name for name, _ in evaluations)
    }
    simulation = Simulation(library.load(TOWN)) if drives else None
    names = entries.names(zoo)
    with stages("refresh cards", len(names)) as on_stage:
        for name in names:
            on_stage(name)
            card = refresh(zoo / name, simulation=simulation)
            if given := read.get(entries.PREFIX + name):
                write_card(dataclasses.replace(card, evaluations=given), zoo / name)


if __name__ == "__main__":
    main()
