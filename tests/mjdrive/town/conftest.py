"""A small town for tests: a rectangle of streets with one street across."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from mjdrive.config import from_dict
from mjdrive.datatypes import Town
from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.road_map import (
    Connection,
    Junction,
    LaneRecord,
    LaneSection,
    Road,
    RoadLink,
    RoadMap,
)
from mjdrive.town.opendrive.road_shapes import Arc, Cubic, Line, Piece
from mjdrive.town.settings import LightTiming
from mjdrive.town.streets.street_builder import build_map
from mjdrive.town.streets.street_plan import StreetPlan

# Machines that run other things too are slow now and then; pytest-timeout catches what hangs.
settings.register_profile("town", deadline=None)
settings.load_profile("town")


def _junction(left: str, right: str, stem: str, *, side: float) -> dict[str, object]:
    """A junction on a horizontal street; the stem leaves to the north (side 1) or the south (side -1)."""
    turns = [
        {"come": come, "go": go, "radius": radius}
        for come, go, near in (
            (left, stem, side > 0),
            (stem, right, side > 0),
            (right, stem, side < 0),
            (stem, left, side < 0),
        )
        for radius in (9.0 if near else 5.0,)
    ]
    pole = (60.0, 40.0 - 35.0 * side)
    lights = [
        {"road": road, "id": f"{stem}{road}{left}", "pole": pole} for road in (left, right, stem)
    ]
    return {"arms": {left: 12.0, right: 12.0, stem: 12.0}, "lights": lights, "turns": turns}


@pytest.fixture(scope="session")
def plan() -> StreetPlan:
    """Corners 10 to 13 of a rectangle of 120 m by 80 m, junctions 20 and 21 in the middle of its long sides."""
    values = {
        "name": "ladder",
        "nodes": {
            "10": [0, 0],
            "11": [120, 0],
            "12": [120, 80],
            "13": [0, 80],
            "20": [60, 0],
            "21": [60, 80],
        },
        "streets": {
            "1": ["10", "20"],
            "2": ["20", "11"],
            "3": ["11", "12"],
            "4": ["12", "21"],
            "5": ["21", "13"],
            "6": ["13", "10"],
            "7": ["20", "21"],
        },
        "corners": {
            "10": {"arms": {"6": 10.0, "1": 10.0}, "radius": 9.0},
            "11": {"arms": {"2": 10.0, "3": 10.0}, "radius": 9.0},
            "12": {"arms": {"3": 10.0, "4": 10.0}, "radius": 9.0},
            "13": {"arms": {"5": 10.0, "6": 10.0}, "radius": 9.0},
        },
        "junctions": {
            "20": _junction("1", "2", "7", side=1.0),
            "21": _junction("5", "4", "7", side=-1.0),
        },
    }
    return from_dict(StreetPlan, values)


@pytest.fixture(scope="session")
def road_map(plan: StreetPlan) -> RoadMap:
    """The OpenDRIVE map of the small town."""
    return build_map(plan)


@pytest.fixture(scope="session")
def map_bytes(road_map: RoadMap) -> bytes:
    """The map of the small town as a file."""
    return opendrive.write(road_map)


@pytest.fixture(scope="session")
def ladder(road_map: RoadMap) -> Town:
    """The small town."""
    return build_town(road_map, name="ladder", timing=LightTiming(), digest="")


@pytest.fixture(scope="session")
def rich_bytes() -> bytes:
    """A small map by hand that uses every feature that is read."""
    return Path(__file__).with_name("rich.xodr").read_bytes()


class RoadMaker:
    """Makes roads with few words."""

    @staticmethod
    def lane(number: int, width: float = 3.5, **more: object) -> LaneRecord:
        """A driving lane, linked to the lanes of the same number on what lies before and behind."""
        facts = {"type": "driving", "predecessor": number, "successor": number, **more}
        widths = facts.pop("widths", (Cubic(0.0, width),) if number else ())
        return LaneRecord(id=number, widths=widths, **facts)

    def section(self, *lanes: int | LaneRecord, s: float = 0.0) -> LaneSection:
        """A section of lanes, given by number or whole; lane 0 is added."""
        records = [self.lane(lane) if isinstance(lane, int) else lane for lane in lanes]
        if all(record.id != 0 for record in records):
            records.append(self.lane(0, type="none"))
        return LaneSection(s, tuple(sorted(records, key=lambda record: -record.id)))

    @staticmethod
    def link(name: str) -> RoadLink | None:
        """A link written "3:start" (the start of road 3), "3:end" or "junction:J"; None for ""."""
        kind, _, rest = name.partition(":")
        if not name:
            return None
        return RoadLink("junction", rest) if kind == "junction" else RoadLink("road", kind, rest)

    def road(
        self,
        name: str,
        ends: tuple[tuple[float, float], tuple[float, float]],
        *sections: LaneSection,
        links: tuple[str, str] = ("", ""),
        **more: object,
    ) -> Road:
        """A straight road between two points [m]."""
        (x, y), far = [tuple(map(float, end)) for end in ends]
        length = float(np.hypot(far[0] - x, far[1] - y))
        pieces = (Piece(0.0, x, y, float(np.arctan2(far[1] - y, far[0] - x)), length, Line()),)
        before, behind = (self.link(link) for link in links)
        facts = {"junction": None, "predecessor": before, "successor": behind, "lane_offsets": ()}
        return Road(name, "", length, pieces=pieces, sections=sections, **(facts | more))

    def ring(self, name: str, radius: float, angles: tuple[float, float], **more: object) -> Road:
        """One lane around the origin, counter-clockwise between two angles [rad]."""
        first, last = map(float, angles)
        start = (radius * float(np.cos(first)), radius * float(np.sin(first)))
        road = self.road(name, (start, start), self.section(-1), **more)
        length = radius * (last - first)
        piece = Piece(0.0, *start, first + np.pi / 2, length, Arc(1.0 / radius))
        return replace(road, length=length, pieces=(piece,))

    @staticmethod
    def junction(name: str, *ways: tuple, controllers: tuple[str, ...] = ()) -> Junction:
        """A junction of ways (incoming road, connecting road, contact, (from lane, to lane), ...)."""
        connections = tuple(
            Connection(str(index), incoming, connecting, contact, tuple(lanes))
            for index, (incoming, connecting, contact, *lanes) in enumerate(ways)
        )
        return Junction(name, "", connections, controllers)

    @staticmethod
    def map(roads: Sequence[Road], junctions: Sequence[Junction] = (), **more: object) -> RoadMap:
        """A map of roads and junctions."""
        return RoadMap("small", {r.id: r for r in roads}, {j.id: j for j in junctions}, **more)


@pytest.fixture(scope="session")
def maker() -> RoadMaker:
    """Makes roads with few words."""
    return RoadMaker()


@pytest.fixture(scope="session")
def roundabout_map(maker: RoadMaker) -> RoadMap:
    """A ring of 8 m radius with an arm in the east ("e") and one in the west ("w"), which end in the open.

    "n" and "s" are the halves of the ring between the junctions E and W. Road "e1" leads from the arm into the ring,
    "e2" from the ring to the arm and "e3" along the ring.
    """
    centred = {"lane_offsets": (Cubic(0.0, 1.75),)}  # the middle of lane -1 is the reference line
    lane, out = maker.section(-1), maker.section(maker.lane(-1, successor=1))
    roads, junctions = [], []
    for arm, ahead, back, side in (("e", "n", "s", 1.0), ("w", "s", "n", -1.0)):
        name, other = arm.upper(), "W" if arm == "e" else "E"
        first = np.deg2rad(30.0) + (0.0 if arm == "e" else np.pi)
        last = first - np.deg2rad(60.0)
        enter, leave = ((8.0 * float(np.cos(a)), 8.0 * float(np.sin(a))) for a in (first, last))
        mouth = {number: (20.0 * side, 1.75 * side * number) for number in (1, -1)}
        inside = {"junction": name, **centred}
        to_ring, to_arm = f"{ahead}:start", f"{arm}:end"
        roads += [
            maker.road(
                arm,
                ((60.0 * side, 0.0), (20.0 * side, 0.0)),
                maker.section(1, -1),
                links=("", f"junction:{name}"),
            ),
            maker.road(f"{arm}1", (mouth[1], enter), lane, links=(to_arm, to_ring), **inside),
            maker.road(f"{arm}2", (leave, mouth[-1]), out, links=(f"{back}:end", to_arm), **inside),
            maker.ring(f"{arm}3", 8.0, (last, first), links=(f"{back}:end", to_ring), **inside),
            maker.ring(
                ahead,
                8.0,
                (first, first + np.deg2rad(120.0)),
                links=(f"junction:{name}", f"junction:{other}"),
                **centred,
            ),
        ]
        ways = [(arm, f"{arm}1"), (back, f"{arm}2"), (back, f"{arm}3")]
        junctions.append(maker.junction(name, *((*way, "start", (-1, -1)) for way in ways)))
    return maker.map(roads, junctions)
