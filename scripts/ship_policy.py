"""Make a shipped policy, `zoo:NAME`, out of a training run and drives that it was evaluated by.

Weights become float16 where that changes little, and the model card gets the commands that make the run, the figures of
the drives and a short reference drive that a test makes again.

Example: python scripts/ship_policy.py runs/da-ibc --name da-ibc --evaluation drives/da-ibc
"""

import shlex
from pathlib import Path

import click

from mjdrive.cli.collect import collect
from mjdrive.cli.console import stages
from mjdrive.cli.main import Script
from mjdrive.errors import ConfigError
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.zoo import entries
from mjdrive.zoo.reference import TOWN
from mjdrive.zoo.shipping import ship, size_of

NUM_STAGES = 4


def data_folder(commands: tuple[str, ...]) -> Path:
    """The folder that the last of some calls of `mjdrive collect` writes to.

    Raises:
        ConfigError: If one of them is no such call.
    """
    folders = []
    for command in commands:
        words = shlex.split(command)
        try:
            if words[:2] != ["mjdrive", "collect"]:
                raise click.UsageError("it does not begin with 'mjdrive collect'")
            given = collect.make_context("collect", words[2:]).params
        except click.ClickException as error:
            raise ConfigError(
                f"Cannot take --collect '{command}': {error.format_message()}. Expected a command as it was given."
            ) from error
        folders.append(given["out"] or Path("data", given["town_name"]))
    return folders[-1]


@click.command(cls=Script)
@click.argument("run", type=click.Path(path_type=Path))
@click.option("--name", required=True, help="What follows zoo: in --policy.")
@click.option(
    "--collect",
    "collects",
    multiple=True,
    default=("mjdrive collect --town town01",),
    show_default=True,
    help="Command that made the demonstrations; may be given again, in order.",
)
@click.option(
    "--evaluation",
    "evaluations",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Drives of `mjdrive drive --episodes N`, of the run or of the entry; may be given again.",
)
@click.option("--set", "acting", multiple=True, help="Change how it acts, as sampler.kind=grid.")
@click.option(
    "--zoo",
    type=click.Path(path_type=Path),
    default=entries.FOLDER,
    help="Folder of the entries. [default: models/zoo]",
)
def main(
    *,
    run: Path,
    name: str,
    collects: tuple[str, ...],
    evaluations: tuple[Path, ...],
    acting: tuple[str, ...],
    zoo: Path,
) -> None:
    """Ship a trained policy."""
    with stages(f"ship {name}", NUM_STAGES) as on_stage:
        card = ship(
            run,
            zoo,
            name=name,
            collects=collects,
            data=data_folder(collects),
            simulation=Simulation(library.load(TOWN)),
            acting=acting,
            evaluations=evaluations,
            on_stage=on_stage,
        )
    weights = card.weights
    print(
        f"{zoo / name}: {weights.number_format}, {size_of(zoo / name) / 1e6:.1f} MB, total variation at most "
        f"{weights.largest_variation:.4f}; reference drive {card.reference.distance_m:.1f} m"
    )


if __name__ == "__main__":
    main()
