from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mjdrive.errors import TownFormatError
from mjdrive.town import library, opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.reference_line import curvature_of, reference_line
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import LightTiming
from mjdrive.town.streets.street_builder import build_map
from mjdrive.town.streets.street_plan import StreetPlan, read_plan

PLANS = Path(__file__).parents[4] / "scripts" / "plans"


@pytest.mark.parametrize("name", sorted(path.stem for path in PLANS.glob("*.toml")))
def test_the_committed_maps_are_those_of_the_plans(name: str) -> None:
    drawn = opendrive.write(build_map(read_plan(PLANS / f"{name}.toml")))
    assert drawn == (library.folder_of(name) / library.MAP_FILE).read_bytes()


def test_streets_end_at_the_arms_of_their_nodes(road_map: RoadMap) -> None:
    (line,) = road_map.roads["1"].pieces
    assert (line.x, line.y, line.heading, line.length) == (10.0, 0.0, 0.0, 38.0)


def test_a_street_has_lane_gutter_and_sidewalk_on_each_side(road_map: RoadMap) -> None:
    (section,) = road_map.roads["1"].sections
    described = [(lane.id, lane.type, [width.a for width in lane.widths]) for lane in section.lanes]
    right = [(-1, "driving", [4.0]), (-2, "shoulder", [0.3]), (-3, "sidewalk", [4.0])]
    left = [(-number, kind, width) for number, kind, width in reversed(right)]
    assert described == [*left, (0, "none", []), *right]
    assert [mark.type for mark in section.lanes[3].marks] == ["broken"]


def test_corners_have_the_radius_of_the_plan(road_map: RoadMap) -> None:
    curvatures = [
        curvature_of(piece) for piece in road_map.roads["10"].pieces if curvature_of(piece)
    ]
    assert curvatures == [pytest.approx(1.0 / 9.0)]


def test_signals_stand_beside_their_approach(road_map: RoadMap) -> None:
    (signal,) = road_map.roads["1"].signals
    assert (signal.from_lane, signal.to_lane, signal.orientation) == (-1, -1, "+")
    (signal,) = road_map.roads["2"].signals
    assert (signal.from_lane, signal.to_lane, signal.orientation) == (1, 1, "-")


def test_a_bent_street_passes_its_bends_without_a_gap(plan: StreetPlan) -> None:
    bent = replace(plan, bends={"3": ((120.0, 30.0), (120.4, 50.0))})
    road_map = build_map(bent)
    build_town(road_map, name="bent", timing=LightTiming(), digest="")  # refuses gaps
    road = road_map.roads["3"]
    assert sum(curvature_of(piece) != 0.0 for piece in road.pieces) == 2
    middle, _ = reference_line(road.pieces, np.linspace(0.0, road.length, 500))
    for bend in bent.bends["3"]:
        assert np.min(np.hypot(*(middle - bend).T)) < 0.25


def test_a_turn_that_does_not_fit_is_named(plan: StreetPlan) -> None:
    junction = plan.junctions["20"]
    turns = tuple(replace(turn, radius=30.0) for turn in junction.turns)
    with pytest.raises(
        TownFormatError,
        match=r"from road '1' to road '7' through junction '20' asks for .*30\.00 m",
    ):
        build_map(replace(plan, junctions={**plan.junctions, "20": replace(junction, turns=turns)}))
