"""`mjdrive towns`: look at towns, check them, bring them in, give them out, make new ones."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import rich_click as click

if TYPE_CHECKING:
    from mjdrive.datatypes import Town

MAP_SUFFIX = ".xodr"

EXIT_FINDINGS = 1
"""Of `check`, where something would break a drive."""


@click.group()
def towns() -> None:
    """List, show, check, import, export and generate towns.

    Towns of your own are folders in towns/ where you work; every command takes them by name.
    """


@towns.command("list")
def list_towns() -> None:
    """List the towns that can be driven in."""
    from mjdrive.cli.town_tables import towns_table
    from mjdrive.town import library

    towns_table({name: library.load(name) for name in library.town_names()})


@towns.command()
@click.argument("name")
@click.option(
    "--picture",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE.png",
    help="Draw the town anew into this file. [default: point at the picture in its folder]",
)
def show(*, name: str, picture: Path | None) -> None:
    """Show the figures of one town and where its picture is."""
    from mjdrive.cli.console import closing_table
    from mjdrive.cli.town_tables import figures_of
    from mjdrive.town import library
    from mjdrive.town import picture as pictures

    town = library.load(name)
    where = picture or library.folder_of(name) / library.PICTURE_FILE
    if picture is not None or not where.is_file():
        pictures.save(town, where)
    closing_table(
        name,
        {**figures_of(town), "picture": where},
        next_command=f"mjdrive drive --town {name} --policy pid",
    )


@towns.command()
@click.argument("name", metavar="NAME|FILE.xodr")
@click.option("--flatten", is_flag=True, help="Check a sloped map file as if it were flat.")
def check(*, name: str, flatten: bool) -> None:
    """Walk every lane of a town or a map file and say what would break a drive.

    The exit status is 1 if something would.
    """
    from mjdrive.cli.town_tables import findings_table
    from mjdrive.town import check as checks
    from mjdrive.town import library, opendrive
    from mjdrive.town.network import build_town
    from mjdrive.town.settings import LightTiming

    file = Path(name)
    if file.suffix.lower() == MAP_SUFFIX or file.is_file():
        road_map = opendrive.read(file, flatten=flatten)
        road_map = opendrive.moved(road_map, opendrive.near_origin(road_map))
        town = build_town(road_map, name=file.stem, timing=LightTiming(), digest="")
    else:
        town = library.load(name)
        settings = library.load_settings(name)
        road_map = opendrive.read(
            library.folder_of(name) / library.MAP_FILE, flatten=settings.flatten
        )
    findings = checks.check(town, road_map)
    findings_table(name, findings)
    if any(finding.breaks_a_drive for finding in findings):
        sys.exit(EXIT_FINDINGS)


@towns.command("import")
@click.argument("file", type=click.Path(path_type=Path), metavar="FILE.xodr")
@click.option("--name", required=True, help="Name of the new town.")
@click.option(
    "--flatten", is_flag=True, help="Use the plan of a sloped map and leave its heights out."
)
@click.option(
    "--seed",
    default=0,
    show_default=True,
    type=click.IntRange(0, 2**32 - 1),
    help="Decides routes and houses.",
)
def import_map(*, file: Path, name: str, flatten: bool, seed: int) -> None:
    """Make a town out of an OpenDRIVE map (1.4 to 1.8)."""
    from mjdrive.cli.console import ended_by_sigterm, stages
    from mjdrive.cli.town_tables import findings_table, report_table
    from mjdrive.simulation.town_files import new_town
    from mjdrive.town import check as checks
    from mjdrive.town import opendrive, town_folder
    from mjdrive.town.settings import SceneryConfig, TownSettings

    town_folder.require_new_name(name)
    document = opendrive.read_bytes(file)
    road_map, report = opendrive.parse_with_report(document, source=str(file), flatten=flatten)
    settings = TownSettings(
        description=f"Imported from {file.name}.",
        scenery=SceneryConfig(seed=seed),
        origin=opendrive.near_origin(road_map),
        flatten=flatten,
    )
    road_map = opendrive.moved(road_map, settings.origin)
    with ended_by_sigterm(), stages(name, 4) as on_stage:
        town, folder = new_town(
            name, document, road_map, settings, seed=seed, report=report, on_stage=on_stage
        )
        on_stage("check")
        findings = checks.check(town, road_map)
    report_table(report)
    findings_table(name, findings)
    _tell(town, folder)


@towns.command()
@click.argument("name")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False), metavar="FILE")
@click.option("--overwrite", is_flag=True, help="Replace a file that is there.")
def export(*, name: str, file: Path, overwrite: bool) -> None:
    """Copy a town out: its OpenDRIVE map (.xodr), its MuJoCo scene (.xml) or its picture (.png)."""
    from mjdrive.cli.console import closing_table
    from mjdrive.simulation.town_export import export_town

    export_town(name, file, overwrite=overwrite)
    closing_table(f"{name}, exported", {"file": file}, next_command="mjdrive towns list")


@towns.command()
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0, 2**32 - 1))
@click.option(
    "--junctions", "num_junctions", default=8, show_default=True, help="T- and X-junctions."
)
@click.option("--name", help="Name of the new town. [default: generated-<junctions>-<seed>]")
def generate(*, seed: int, num_junctions: int, name: str | None) -> None:
    """Make a new town of T- and X-junctions: the same seed makes the same town."""
    from mjdrive.cli.console import ended_by_sigterm, stages
    from mjdrive.simulation.town_files import new_town
    from mjdrive.town import opendrive, town_folder
    from mjdrive.town.settings import SceneryConfig, TownSettings
    from mjdrive.town.streets import generator
    from mjdrive.town.streets.street_builder import build_map

    name = name or f"generated-{num_junctions}-{seed}"
    town_folder.require_new_name(name)
    plan = generator.generate_plan(name=name, num_junctions=num_junctions, seed=seed)
    road_map = build_map(plan)
    settings = TownSettings(
        description=f"Generated: {num_junctions} junctions, seed {seed}.",
        scenery=SceneryConfig(seed=seed),
    )
    with ended_by_sigterm(), stages(name, 3) as on_stage:
        made = new_town(
            name, opendrive.write(road_map), road_map, settings, seed=seed, on_stage=on_stage
        )
    _tell(*made)


def _tell(town: "Town", folder: Path) -> None:
    """Say what was made and what it is good for."""
    from mjdrive.cli.console import closing_table
    from mjdrive.cli.town_tables import figures_of
    from mjdrive.town import library

    closing_table(
        f"Town '{town.name}'",
        {"folder": folder, **figures_of(town), "picture": folder / library.PICTURE_FILE},
        next_command=f"mjdrive drive --town {town.name} --policy pid",
    )
