"""The folder of a new town: all of its files, or none.

MuJoCo has no part in this: it would take longer to load than a map takes to read. Drives build the scene anew, and
`town_export` writes it for those who want to see it.
"""

from collections.abc import Callable
from pathlib import Path

from mjdrive.bev.rasters import require_drawable
from mjdrive.config import write_json
from mjdrive.datatypes import Town
from mjdrive.town import library, picture
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.read_report import ReadReport
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import TownSettings
from mjdrive.town.town_folder import fill, new_town_folder

REPORT_FILE = "import.json"


def new_town(
    name: str,
    document: bytes,
    road_map: RoadMap,
    settings: TownSettings,
    *,
    seed: int,
    report: ReadReport | None = None,
    on_stage: Callable[[str], None] = lambda stage: None,
) -> tuple[Town, Path]:
    """Make a town out of an OpenDRIVE map: map, settings and picture, or nothing at all.

    Args:
        name: Name of the new town.
        document: The map as a file.
        road_map: What it says.
        settings: What town.json shall say; routes are found if it names none.
        seed: Decides the routes.
        report: What reading the map left out, to be kept beside it.
        on_stage: Told what is made next.

    Returns:
        The town and its folder.

    Raises:
        ConfigError: If the name is none for a town.
        NameTakenError: If there is a town of that name.
        TownFormatError: If the map cannot be driven, or is too large to be drawn.
    """
    with new_town_folder(name) as folder:
        on_stage("lanes and lights")
        town = build_town(road_map, name=name, timing=settings.lights, digest="")
        require_drawable(town)
        on_stage("routes")
        town = fill(folder, document, town, settings, seed=seed)
        on_stage("picture")
        picture.save(town, folder / library.PICTURE_FILE)
        if report is not None:
            write_json(report, folder / REPORT_FILE)
    return town, library.folder_of(name)
