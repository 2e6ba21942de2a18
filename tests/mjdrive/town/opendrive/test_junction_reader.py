import pytest

from mjdrive.errors import TownFormatError
from mjdrive.town import opendrive
from mjdrive.town.opendrive.road_map import Connection, RoadMap


@pytest.fixture(scope="module")
def rich(rich_bytes: bytes) -> RoadMap:
    return opendrive.parse(rich_bytes, source="rich")


def test_connections_are_read_in_order(rich: RoadMap) -> None:
    junction = rich.junctions["100"]
    assert junction.connections[1] == Connection("1", "2", "10", "end", ((1, 1),))
    assert [connection.connecting for connection in junction.connections] == [
        "10",
        "10",
        "11",
        "12",
        "13",
        "14",
    ]


def test_controllers_take_turns_by_sequence(rich: RoadMap) -> None:
    assert rich.junctions["100"].controllers == ("600", "601")


def test_direct_junctions_lead_both_ways(rich: RoadMap) -> None:
    assert rich.junctions["200"].connections == (
        Connection("0", "3", "4", "start", ((-1, -1), (1, 1))),
        Connection("1", "3", "5", "start", ((-1, -1),)),
        Connection("0_back", "4", "3", "end", ((-1, -1), (1, 1))),
        Connection("1_back", "5", "3", "end", ((-1, -1),)),
    )


def test_virtual_junctions_connect_nothing(rich: RoadMap) -> None:
    assert rich.junctions["300"].connections == ()
    assert rich.roads["20"].junction == "300"
    assert rich.roads["20"].predecessor is None


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (b'linkedRoad="4"', b'linkedRoad="404"', "linkedRoad='404', which is no road"),
        (b'linkedRoad="4"', b"", "<connection> has no attribute 'linkedRoad'"),
        (b'<laneLink from="-1"', b'<laneLink from="right"', "<laneLink> has from='right'; exp"),
        (b'type="0" sequence="1"', b'sequence="last"', "<controller> has sequence='last'; expect"),
        (b'junction="300"', b'junction="301"', "<road> crosses junction '301', which the map doe"),
    ],
)
def test_a_broken_junction_is_refused(
    rich_bytes: bytes, old: bytes, new: bytes, complaint: str
) -> None:
    assert old in rich_bytes
    with pytest.raises(TownFormatError, match=rf"map:\d+.*{complaint}"):
        opendrive.parse(rich_bytes.replace(old, new, 1), source="map")
