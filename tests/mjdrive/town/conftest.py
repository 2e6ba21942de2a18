"""A small town for tests: a rectangle of streets with one street across."""

from pathlib import Path

import pytest
from hypothesis import settings

from mjdrive.config import from_dict
from mjdrive.datatypes import Town
from mjdrive.town import opendrive_writer
from mjdrive.town.network import build_town
from mjdrive.town.road_map import RoadMap
from mjdrive.town.settings import LightTiming
from mjdrive.town.street_builder import build_map
from mjdrive.town.street_plan import StreetPlan

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
    pole = (60.0, 5.0 * side)
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
    return opendrive_writer.write(road_map)


@pytest.fixture(scope="session")
def ladder(road_map: RoadMap) -> Town:
    """The small town."""
    return build_town(road_map, name="ladder", timing=LightTiming(), digest="")


@pytest.fixture(scope="session")
def rich_bytes() -> bytes:
    """A small map by hand that uses every feature that is read."""
    return Path(__file__).with_name("rich.xodr").read_bytes()
