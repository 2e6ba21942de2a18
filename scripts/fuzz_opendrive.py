"""Throw mutated maps at the OpenDRIVE reader: each must become a town, every eighth also a scene, or a named error.

    python scripts/fuzz_opendrive.py tests/mjdrive/town/rich.xodr --seconds 300

Needs atheris (`pip install atheris`). What breaks is left in the folder as crash-*, what hangs as timeout-*.
"""

import argparse
import copy
import random
import sys
import tempfile
import warnings
import zlib
from pathlib import Path

import atheris
from lxml import etree

with atheris.instrument_imports(include=["mjdrive.town"]):
    from mjdrive.errors import MjdriveError
    from mjdrive.simulation.scene import build_scene, compile_scene
    from mjdrive.town import check, opendrive
    from mjdrive.town.network import build_town
    from mjdrive.town.settings import LightTiming, TownSettings

VALUES = [
    "",
    "nan",
    "inf",
    "-inf",
    "0",
    "-1",
    "1",
    "1e9",
    "-1e9",
    "1e-9",
    "1e308",
    "text",
    "0.5",
    "7",
    "1e-300",
    "true",
]
"""What attributes are set to."""

LARGEST_INPUT = 100_000
"""Longest document that libFuzzer makes [byte]."""

SLOWEST = 20
"""A document that takes longer counts as hanging [s]."""


def try_map(data: bytes) -> None:
    """Read a document, build and check its town and now and then its scene; any error but a named one is a defect."""
    try:
        road_map = opendrive.parse(data, source="fuzz", flatten=bool(len(data) % 2))
        town = build_town(road_map, name="fuzz", timing=LightTiming(), digest="")
        check.check(town, road_map)
        # A scene takes a hundred times as long as a town.
        if zlib.crc32(data) % 8 == 0:
            compile_scene(build_scene(town, TownSettings(), timestep=0.005))
    except MjdriveError:
        pass


def mutate(data: bytes, max_size: int, seed: int) -> bytes:
    """Change a document as a tree most of the time, so that it stays XML, and as bytes now and then."""
    chooser = random.Random(seed)
    try:
        root = etree.fromstring(data, etree.XMLParser(resolve_entities=False))
    except etree.XMLSyntaxError:
        return bytes(atheris.Mutate(data, max_size))
    if chooser.random() < 0.05:
        return bytes(atheris.Mutate(data, max_size))
    for _ in range(chooser.randint(1, 2)):
        mutate_tree(root, chooser)
    changed: bytes = etree.tostring(root)
    return changed if len(changed) <= max_size else data


def mutate_tree(root: etree._Element, chooser: random.Random) -> None:
    """Change, drop, copy, move or rename one element, or change one of its attributes."""
    elements = list(root.iter("*"))
    element = chooser.choice(elements)
    other = chooser.choice(elements)
    names = list(element.attrib)
    kind = chooser.random()
    if kind < 0.6 and names:
        value = chooser.choice(
            [*VALUES, *other.attrib.values(), repr(chooser.uniform(-20.0, 20.0))]
        )
        element.set(chooser.choice(names), value)
    elif kind < 0.7 and names:
        del element.attrib[chooser.choice(names)]
    elif kind < 0.75:
        element.tag = other.tag
    elif element is not root and kind < 0.85:
        element.getparent().remove(element)
    elif element is not root:
        copied = copy.deepcopy(element)
        if kind < 0.95:
            element.addnext(copied)
        else:
            other.append(copied)


def main() -> None:
    """Fuzz for a number of seconds, from the maps given."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("maps", nargs="+", type=Path, help="maps to start from (.xodr)")
    parser.add_argument("--seconds", type=int, default=300, help="how long to go on [s]")
    parser.add_argument("--seed", type=int, default=1, help="seed of the mutations")
    arguments = parser.parse_args()
    # numpy's warnings about numbers out of range are defects too.
    warnings.simplefilter("error")
    with tempfile.TemporaryDirectory() as corpus:
        for number, path in enumerate(arguments.maps):
            (Path(corpus) / str(number)).write_bytes(path.read_bytes())
        options = [
            f"-max_total_time={arguments.seconds}",
            f"-max_len={LARGEST_INPUT}",
            f"-timeout={SLOWEST}",
            f"-seed={arguments.seed}",
            "-rss_limit_mb=4096",
            "-print_final_stats=1",
        ]
        atheris.Setup([sys.argv[0], *options, corpus], try_map, custom_mutator=mutate)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
