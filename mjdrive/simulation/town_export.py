"""What a town is to other tools: its map, its MuJoCo scene, its picture."""

from pathlib import Path

from mjdrive.config import SimulationConfig
from mjdrive.errors import ConfigError, NameTakenError
from mjdrive.files import write_atomically
from mjdrive.simulation.scene import build_scene, scene_xml
from mjdrive.town import library, picture


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
            spec = build_scene(town, settings, timestep=SimulationConfig().timestep)
            write_atomically(file, scene_xml(spec).encode())
        case ".png":
            picture.save(town, file)
        case other:
            raise ConfigError(
                f"Cannot export '{file}': expected a file that ends in .xodr (OpenDRIVE map), .xml (MuJoCo "
                f"scene) or .png (picture), not '{other}'."
            )
