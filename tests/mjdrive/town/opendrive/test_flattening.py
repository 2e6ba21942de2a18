import re

import pytest

from mjdrive.errors import TownFormatError
from mjdrive.town import opendrive
from mjdrive.town.opendrive.flattening import Flattening

ELEVATION = b'<elevation s="0" a="0" b="0" c="0" d="0"/>'
SLOPES = [
    (ELEVATION, b'<elevation s="0" a="0" b="0.1" c="0" d="0"/>', 3.0, 0.1),
    # Up to 2.25 m at the end, where it is level.
    (ELEVATION, b'<elevation s="0" a="0" b="0.15" c="-0.0025" d="0"/>', 2.25, 0.15),
    (ELEVATION, b'<elevation s="0" a="3" b="0" c="0" d="0"/>', 3.0, 0.0),
    (
        b'<superelevation s="0" a="0"',
        b'<superelevation s="0" a="0.1"',
        0.0,
        pytest.approx(0.100335, abs=1e-6),
    ),
    (
        b'<crossfall s="0" side="both" a="0"',
        b'<crossfall s="0" side="both" a="0.05"',
        0.0,
        pytest.approx(0.050042, abs=1e-6),
    ),
    (b'<shape s="0" t="-4" a="0" b="0"', b'<shape s="0" t="-4" a="0" b="0.02"', 0.0, 0.02),
    (
        b"</lateralProfile>",
        b'<crossSectionSurface><surfaceStrips><strip id="1"><linear><coefficients s="0" a="0.3" b="0" c="0" d="0"/>'
        b"</linear></strip></surfaceStrips></crossSectionSurface></lateralProfile>",
        0.0,
        0.3,
    ),
]


@pytest.mark.parametrize(("old", "new", "height", "slope"), SLOPES)
def test_slopes_are_refused_or_told(
    rich_bytes: bytes, old: bytes, new: bytes, height: float, slope: float
) -> None:
    # On road 3: the first road of the file says how high the plane is.
    sloped = _with_profile_on_road_3(rich_bytes, old, new)
    with pytest.raises(TownFormatError, match=r"map:\d+, road '3': <road> is not flat.*--flatten"):
        opendrive.parse(sloped, source="map")
    road_map, report = opendrive.parse_with_report(sloped, source="map", flatten=True)
    assert road_map == opendrive.parse(rich_bytes, source="map")
    assert report.flattened.roads == 1
    assert report.flattened.height == pytest.approx(height)
    assert report.flattened.slope == slope


def _with_profile_on_road_3(document: bytes, old: bytes, new: bytes) -> bytes:
    profiles = re.search(rb"<elevationProfile>.*</lateralProfile>", document, re.DOTALL)
    assert profiles is not None
    assert old in profiles[0]
    head, tail = document.split(b'<road id="3"')
    return (
        head
        + b'<road id="3"'
        + tail.replace(b"<lanes>", profiles[0].replace(old, new) + b"<lanes>", 1)
    )


def test_a_flat_map_needs_no_flattening(rich_bytes: bytes) -> None:
    flat = opendrive.parse_with_report(rich_bytes, source="map", flatten=True)[1].flattened
    assert flat == Flattening(roads=0, height=0.0, slope=0.0)


def test_a_plane_above_zero_is_flat(rich_bytes: bytes) -> None:
    high = b'<elevationProfile><elevation s="0" a="250" b="0" c="0" d="0"/></elevationProfile>'
    lifted = re.sub(rb"<elevationProfile>.*?</elevationProfile>", b"", rich_bytes)
    lifted = lifted.replace(b"</planView>", b"</planView>" + high)
    assert opendrive.parse_with_report(lifted, source="map")[1].flattened.roads == 0


def test_unevenness_below_a_centimetre_is_flat(rich_bytes: bytes) -> None:
    uneven = rich_bytes.replace(ELEVATION, b'<elevation s="0" a="0.005" b="0" c="0" d="0"/>')
    assert opendrive.parse(uneven, source="map") == opendrive.parse(rich_bytes, source="map")
