"""Maps with mistakes that become a town become a scene too, or the mistake is named: no other exception, no hang."""

import contextlib
import os
import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lxml import etree

from mjdrive.errors import MjdriveError
from mjdrive.simulation.scene import build_scene, compile_scene
from mjdrive.town import check, opendrive
from mjdrive.town.network import build_town
from mjdrive.town.settings import LightTiming, TownSettings

# More by hand: MJDRIVE_FUZZ_EXAMPLES=2000 pytest ...
EXAMPLES = int(os.environ.get("MJDRIVE_FUZZ_EXAMPLES", "20"))

RICH = Path(__file__).parents[1] / "town" / "rich.xodr"

# Without its namespace, which tags would have to name.
PLAIN = re.sub(rb" xmlns=\"[^\"]*\"", b"", RICH.read_bytes())

NUMBERS = ["0", "-1", "1e9", "-1e9", "1e5", "1e3", "1e-9", "1e-300", "7", "0.001"]


def _try_map(data: bytes) -> None:
    with contextlib.suppress(MjdriveError):
        road_map = opendrive.parse(data, source="fuzz", flatten=True)
        town = build_town(road_map, name="fuzz", timing=LightTiming(), digest="")
        check.check(town, road_map)
        compile_scene(build_scene(town, TownSettings(), timestep=0.005))


@settings(
    max_examples=EXAMPLES,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
@given(draws=st.data())
def test_a_map_with_odd_values_becomes_a_scene_or_its_mistake_is_named(
    draws: st.DataObject,
) -> None:
    root = etree.fromstring(PLAIN)
    elements = [element for element in root.iter("*") if element.attrib]
    for _ in range(draws.draw(st.integers(1, 3))):
        element = draws.draw(st.sampled_from(elements))
        name = draws.draw(st.sampled_from(sorted(element.attrib)))
        element.set(name, draws.draw(st.sampled_from([*NUMBERS, "text"])))
    _try_map(etree.tostring(root))


@pytest.mark.parametrize("number", ["1e9", "1e-9", "7"])
@pytest.mark.parametrize(
    "where",
    [
        "//road/lanes/laneSection/*/lane/width/@a",
        "//road/objects/object//cornerLocal[1]/@u",
        "//road/objects/object/@height",
        "//roadMark/@width",
        "//roadMark/type/line/@space",
    ],
)
def test_sizes_of_any_size_become_a_scene_or_are_refused(where: str, number: str) -> None:
    root = etree.fromstring(PLAIN)
    values = root.xpath(where)
    assert values
    for value in values:
        value.getparent().set(value.attrname, number)
    _try_map(etree.tostring(root))


@pytest.mark.parametrize("color", ["black", "violet", "VIOLET", "mauve", "1e-9"])
def test_every_color_becomes_a_scene(color: str) -> None:
    root = etree.fromstring(PLAIN)
    for mark in root.iter("roadMark"):
        mark.set("color", color)
    _try_map(etree.tostring(root))
