import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from mjdrive.town import opendrive
from mjdrive.town.opendrive.read_report import ReadReport


def _report(data: bytes) -> ReadReport:
    return opendrive.parse_with_report(data, source="map")[1]


def test_what_was_read_is_counted(rich_bytes: bytes) -> None:
    report = _report(rich_bytes)
    assert (report.source, report.version) == ("map", "1.8")
    assert (report.roads, report.junctions) == (12, 3)
    assert report.signals == {"1000001": 3, "206": 1, "274": 1}
    assert report.objects == {"barrier": 5, "building": 1, "crosswalk": 1, "pole": 1, "tree": 1}
    # Lanes count once in each section: sidewalk and left lane of road 1 go through three.
    assert report.lanes["sidewalk"] == 3
    assert report.lanes["tram"] == 1
    lengths = [60.0, 97.131142122, 30.0, 30.0, 30.0, 20.0, 40.0] + [15.707963268] * 5
    assert report.length == pytest.approx(sum(lengths))


@pytest.mark.parametrize(
    ("what", "count"),
    [
        ("road/railroad", 1),
        ("road/surface", 1),
        ("road/type", 1),
        ("road/objects/tunnel", 1),
        ("road/objects/object/outlines/outline", 1),
        ("road/signals/signal/positionInertial", 1),
        ("road/lanes/laneSection/left/lane/speed", 1),
        ("junction/priority", 1),
        ("junction/connection", 1),
        ("junctionGroup", 1),
        ("road/signals/signal@zOffset", 3),
        ("lane type 'tram'", 1),
        ("signal type '206'", 1),
        ("junction type 'virtual'", 1),
        ("road link that meets a road between its ends (elementS)", 1),
        ("lane with a negative width, which counts as 0", 1),
        ("object of type 'pole' without extent", 1),
    ],
)
def test_what_is_not_used_is_listed(rich_bytes: bytes, what: str, count: int) -> None:
    assert _report(rich_bytes).not_used[what] == count


def test_a_plain_map_leaves_nothing_out(map_bytes: bytes) -> None:
    # The light poles of the ladder have heights in no sense: only the country of signals is not used.
    assert set(_report(map_bytes).not_used) <= {"road/signals/signal@country", "road/type"}


@settings(max_examples=20)
@given(draws=st.data())
def test_an_unknown_element_is_reported_wherever_it_stands(
    rich_bytes: bytes, draws: st.DataObject
) -> None:
    root = etree.fromstring(rich_bytes)
    element = draws.draw(st.sampled_from(list(root.iter("*"))))
    namespace = f"{{{etree.QName(root).namespace}}}"
    etree.SubElement(element, f"{namespace}future").set("value", "1")
    after = _report(etree.tostring(root)).not_used
    path = root.getroottree().getelementpath(element).replace(namespace, "")
    parts = [part.split("[")[0] for part in path.split("/")]
    here = [] if parts == ["."] else parts
    # What is not used is listed once, with all that it holds.
    shown = next(
        ("/".join(here[:n]) for n in range(1, len(here) + 1) if "/".join(here[:n]) in after), None
    )
    assert "/".join([*here, "future"]) in after or shown is not None


@settings(max_examples=20)
@given(draws=st.data())
def test_an_unknown_attribute_is_reported_on_every_element_in_use(
    rich_bytes: bytes, draws: st.DataObject
) -> None:
    root = etree.fromstring(rich_bytes)
    namespace = f"{{{etree.QName(root).namespace}}}"
    roads = list(root.iterchildren(f"{namespace}road"))
    used = [*roads, *root.iter(f"{namespace}laneSection", f"{namespace}roadMark")]
    element = draws.draw(st.sampled_from(used))
    element.set("future", "yes")
    found = [name for name in _report(etree.tostring(root)).not_used if name.endswith("@future")]
    assert len(found) == 1
    assert found[0].split("@")[0].split("/")[-1] == etree.QName(element).localname
