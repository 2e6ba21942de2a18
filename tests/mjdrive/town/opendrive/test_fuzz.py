"""Maps with mistakes become a town or a named error: no other exception, no hang."""

import contextlib
import copy
import os

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lxml import etree

from mjdrive.errors import MjdriveError
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.xml_fields import Element
from mjdrive.town.settings import LightTiming

# More by hand: MJDRIVE_FUZZ_EXAMPLES=2000 pytest ...
EXAMPLES = int(os.environ.get("MJDRIVE_FUZZ_EXAMPLES", "12"))

WORDS = ["true", "text", "start", "end", "9" * 400, "\u0663", "\u202e", "none", "+", "-"]

# What is seen in broken maps, and what breaks programs.
VALUES = st.sampled_from(
    [
        "",
        " ",
        "nan",
        "inf",
        "-inf",
        "0",
        "-1",
        "1",
        "2",
        "1e9",
        "-1e9",
        "1e308",
        "1e-300",
        "5e-324",
        *WORDS,
    ]
) | st.floats(-100.0, 100.0).map(repr)


@st.composite
def mutations(draw: st.DrawFn, root: Element) -> None:
    """Change one thing of a document: an attribute, an element or where it stands."""
    elements = list(root.iter("*"))
    element, other = (draw(st.sampled_from(elements)) for _ in range(2))
    kind = draw(
        st.sampled_from(["set", "set", "set", "borrow", "delete", "rename", "drop", "copy", "move"])
    )
    if kind in ("set", "borrow", "delete") and element.attrib:
        name = draw(st.sampled_from(sorted(element.attrib)))
        if kind == "set":
            element.set(name, draw(VALUES))
        elif kind == "borrow":
            element.set(name, next(iter(other.attrib.values()), ""))
        else:
            del element.attrib[name]
    elif kind == "rename":
        element.tag = other.tag
    elif element is not root:
        copied = copy.deepcopy(element)
        if kind in ("drop", "move"):
            element.getparent().remove(element)
        if kind == "copy":
            element.addnext(copied)
        elif kind == "move" and element not in other.iterancestors() and element is not other:
            other.append(copied)


def _works_or_names_the_mistake(data: bytes, *, flatten: bool) -> None:
    with contextlib.suppress(MjdriveError):
        road_map = opendrive.parse(data, source="fuzz", flatten=flatten)
        build_town(road_map, name="fuzz", timing=LightTiming(), digest="")


@pytest.mark.parametrize("fixture", ["map_bytes", "rich_bytes"])
def test_a_broken_map_works_or_its_mistake_is_named(
    fixture: str, request: pytest.FixtureRequest
) -> None:
    data: bytes = request.getfixturevalue(fixture)

    @settings(max_examples=EXAMPLES, suppress_health_check=[HealthCheck.too_slow], deadline=None)
    @given(draws=st.data(), number=st.integers(1, 3), flatten=st.booleans())
    def check(draws: st.DataObject, number: int, flatten: bool) -> None:
        root = etree.fromstring(data)
        for _ in range(number):
            draws.draw(mutations(root))
        _works_or_names_the_mistake(etree.tostring(root), flatten=flatten)

    check()


@settings(max_examples=EXAMPLES, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(draws=st.data())
def test_a_file_cut_or_spoilt_works_or_is_named(rich_bytes: bytes, draws: st.DataObject) -> None:
    start, end = sorted(draws.draw(st.integers(0, len(rich_bytes))) for _ in range(2))
    spoilt = rich_bytes[:start] + draws.draw(st.binary(max_size=8)) + rich_bytes[end:]
    _works_or_names_the_mistake(spoilt, flatten=False)
