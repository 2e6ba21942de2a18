"""Write assets/towns/<name>/map.xodr and map.png from the street plans beside this file.

Usage: python scripts/make_towns.py [NAME ...]
"""

import sys
from pathlib import Path

from mjdrive.town import library, opendrive, picture
from mjdrive.town.streets.street_builder import build_map
from mjdrive.town.streets.street_plan import read_plan

PLANS = Path(__file__).parent / "plans"


def main(names: list[str]) -> None:
    """Make the named towns, or all that have a street plan."""
    for name in names or sorted(path.stem for path in PLANS.glob("*.toml")):
        folder = library.towns_folder() / name
        folder.mkdir(exist_ok=True)
        road_map = opendrive.write(build_map(read_plan(PLANS / f"{name}.toml")))
        (folder / library.MAP_FILE).write_bytes(road_map)
        picture.save(library.load_folder(folder), folder / "map.png")
        print(f"{folder}: {len(road_map) / 1000:.0f} kB of map")


if __name__ == "__main__":
    main(sys.argv[1:])
