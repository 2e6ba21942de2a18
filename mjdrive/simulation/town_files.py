"""The files of a town folder: written together for a new town, copied out one by one."""

from collections.abc import Callable
from pathlib import Path

from mjdrive.bev.rasters import require_drawable
from mjdrive.config import SimulationConfig, write_json
from mjdrive.datatypes import Town
from mjdrive.errors import ConfigError, NameTakenError
from mjdrive.files import write_atomically
from mjdrive.simulation.scene import build_scene, scene_xml
from mjdrive.town import library, picture
from mjdrive.town.opendrive.read_report import ReadReport
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import TownSettings
from mjdrive.town.town_folder import fill, new_town_folder

SCENE_FILE = "scene.xml"
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
    """Make a town out of an OpenDRIVE map: map, settings, scene and picture, or nothing at all.

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
        TownFormatError: If the map cannot be driven.
    """
    with new_town_folder(name) as folder:
        on_stage("routes")
        town = fill(folder, document, road_map, settings, seed=seed)
        require_drawable(town)
        on_stage("scene")
        write_scene(town, settings, folder / SCENE_FILE)
        on_stage("picture")
        picture.save(town, folder / library.PICTURE_FILE)
        if report is not None:
            write_json(report, folder / REPORT_FILE)
    return town, library.folder_of(name)


def write_scene(town: Town, settings: TownSettings, path: Path) -> None:
    """Write the MuJoCo scene of a town as MJCF.

    Args:
        town: Road network.
        settings: What stands beside the roads.
        path: File to write.
    """
    spec = build_scene(town, settings, timestep=SimulationConfig().timestep)
    write_atomically(path, scene_xml(spec).encode())


def export_town(name: str, file: Path, *, overwrite: bool = False) -> None:
    """Copy a town out; the ending of the file says what: .xodr, .xml or .png.

    Args:
        name: Name of the town.
        file: File to write.
        overwrite: Whether to replace a file that is there.

    Raises:
        UnknownNameError: If there is no such town.
        NameTakenError: If the file is there and is not to be replaced.
        ConfigError: If the ending says nothing.
    """
    town, settings = library.load(name), library.load_settings(name)
    if file.exists() and not overwrite:
        raise NameTakenError(
            f"'{file}' is there already. Give another file, or replace it with --overwrite."
        )
    match file.suffix:
        case ".xodr":
            write_atomically(file, (library.folder_of(name) / library.MAP_FILE).read_bytes())
        case ".xml":
            write_scene(town, settings, file)
        case ".png":
            picture.save(town, file)
        case other:
            raise ConfigError(
                f"Cannot export '{file}': expected a file that ends in .xodr (OpenDRIVE map), .xml (MuJoCo "
                f"scene) or .png (picture), not '{other}'."
            )
