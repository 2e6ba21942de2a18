"""Time `mjdrive towns import` on a large map: copies of a town side by side, as a whole and stage by stage.

    python scripts/bench/import_map.py                          # 88 copies of town02, 10 MB
    python scripts/bench/import_map.py --map Town01.xodr --copies 1
    python scripts/bench/import_map.py --stages --scene         # and what a drive builds of it

Times are processor time, so that a busy machine troubles them less; memory is the most that a process held (Linux).
"""

import copy
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import click
from lxml import etree

from mjdrive.config import SimulationConfig
from mjdrive.simulation.scene import build_scene, compile_scene
from mjdrive.town import check, library, opendrive, picture
from mjdrive.town.network import build_town
from mjdrive.town.scenery import lay_out
from mjdrive.town.settings import TownSettings
from mjdrive.town.town_folder import found_routes

STREET = 10.0
"""Between two copies [m]."""

NAMING = {
    "road": ("id", "junction"),
    "junction": ("id",),
    "controller": ("id",),
    "signal": ("id",),
    "signalReference": ("id",),
    "predecessor": ("elementId",),
    "successor": ("elementId",),
    "connection": ("incomingRoad", "connectingRoad"),
    "control": ("signalId",),
}
"""Attributes that name parts of a map, by the tag of their element."""


WATCH = """
import resource, subprocess, sys, time
begin = time.monotonic()
subprocess.run(sys.argv[1:], check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime, used.ru_maxrss, time.monotonic() - begin)
"""
"""Runs a command from a process that holds next to nothing: a new process begins with the peak of the one before."""


def copies_of(document: bytes, count: int, *, width: float, height: float) -> bytes:
    """Lay copies of a map out in rows, each with names of its own.

    Args:
        document: OpenDRIVE map.
        count: How many [-].
        width: From one copy to the next in a row [m].
        height: From one row to the next [m].

    Returns:
        The map of all copies.
    """
    original = etree.fromstring(document)
    columns = max(1, round((count * height / width) ** 0.5))
    merged = etree.Element("OpenDRIVE")
    merged.append(copy.deepcopy(original.find("header")))
    parts = [
        _moved(original, f"{number:04d}", width * (number % columns), height * (number // columns))
        for number in range(count)
    ]
    for tag in ("road", "controller", "junction"):
        merged.extend(element for part in parts for element in part.findall(tag))
    return bytes(etree.tostring(merged, xml_declaration=True, encoding="UTF-8"))


def _moved(original: etree._Element, prefix: str, dx: float, dy: float) -> etree._Element:
    """Copy a map to another place and put a prefix before the names of its parts."""
    moved = copy.deepcopy(original)
    for element in moved.iter(*NAMING):
        for name in NAMING[element.tag]:
            if element.get(name) not in (None, "-1"):
                element.set(name, prefix + element.get(name))
    for element in moved.iter("geometry"):
        element.set("x", repr(float(element.get("x")) + dx))
        element.set("y", repr(float(element.get("y")) + dy))
    return moved


def stages(path: Path, *, scene: bool) -> Iterator[str]:
    """Go through an import stage by stage; yields the name of each when it is done."""
    yield "start, with MuJoCo, which an import does not load"
    settings = TownSettings()
    road_map = opendrive.read(path)
    yield f"read {path.stat().st_size / 1e6:.1f} MB"
    town = build_town(road_map, name="bench", timing=settings.lights, digest="")
    yield f"build {len(town.lanes)} lanes"
    yield f"find {len(found_routes(town, seed=0))} routes"
    with tempfile.TemporaryDirectory() as folder:
        picture.save(town, Path(folder) / "map.png")
    yield "draw the picture"
    check.check(town, road_map)
    yield "check"
    if scene:
        layout = lay_out(town, settings.scenery)
        yield f"lay out {len(layout.buildings)} houses and {len(layout.trees)} trees"
        spec = build_scene(town, settings, timestep=SimulationConfig().timestep)
        yield "build the scene, with its layout"
        compile_scene(spec)
        yield "compile the scene"


def time_stages(path: Path, *, scene: bool) -> None:
    """Print what each stage of an import takes in this process."""
    before = 0.0
    for stage in stages(path, scene=scene):
        now = time.process_time()
        status = Path("/proc/self/status").read_text(encoding="utf-8")
        peak = re.search(r"VmHWM:\s+(\d+) kB", status)
        assert peak is not None
        print(f"{now - before:8.2f} s {float(peak[1]) * 1024 / 1e6:6.0f} MB  {stage}", flush=True)
        before = now


def time_command(path: Path) -> None:
    """Print what the whole command takes."""
    mjdrive = [sys.executable, "-m", "mjdrive", "towns", "import", str(path), "--name", "bench"]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, "-c", WATCH, *mjdrive],
            cwd=folder,
            check=False,
            capture_output=True,
            text=True,
        )
    if done.returncode:
        sys.exit(done.stderr)
    seconds, kilobytes, wall = map(float, done.stdout.split()[-3:])
    print(
        f"{seconds:8.2f} s {kilobytes * 1024 / 1e6:6.0f} MB  the whole command, {wall:.2f} s by the clock"
    )


@click.command()
@click.option("--town", default="town02", show_default=True, help="Town to copy.")
@click.option("--map", "map_file", type=click.Path(path_type=Path), help="Map to copy instead.")
@click.option("--copies", default=88, show_default=True, help="How many, side by side.")
@click.option("--keep", type=click.Path(path_type=Path), help="Keep the map in this file.")
@click.option("--stages", "by_stage", is_flag=True, help="Time the stages, not the command.")
@click.option("--scene", is_flag=True, help="Among them what a drive builds of the town.")
@click.option("--as-it-is", is_flag=True, hidden=True)
def main(
    *,
    town: str,
    map_file: Path | None,
    copies: int,
    keep: Path | None,
    by_stage: bool,
    scene: bool,
    as_it_is: bool,
) -> None:
    """Make a large map and time its import."""
    source = map_file or library.folder_of(town) / library.MAP_FILE
    if as_it_is:
        time_stages(source, scene=scene)
        return
    one = build_town(opendrive.read(source), name="one", timing=TownSettings().lights, digest="")
    west, south, east, north = one.bounds.tolist()
    size = {"width": east - west + STREET, "height": north - south + STREET}
    with tempfile.TemporaryDirectory() as folder:
        path = (keep or Path(folder) / "large.xodr").resolve()
        path.write_bytes(copies_of(source.read_bytes(), copies, **size))
        print(f"{copies} copies of {source.name}, {path.stat().st_size / 1e6:.1f} MB")
        if by_stage:
            options = ["--map", str(path), "--as-it-is", *(["--scene"] if scene else [])]
            subprocess.run([sys.executable, __file__, *options], check=True)
        else:
            time_command(path)


if __name__ == "__main__":
    main()
