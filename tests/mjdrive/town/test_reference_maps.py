"""Compare town01 and town02 with CARLA's own maps, where a folder with them is given."""

import os
from pathlib import Path

import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Move, Town
from mjdrive.town import library, opendrive
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.network import build_town
from mjdrive.town.settings import LightTiming

FOLDER = os.environ.get("MJDRIVE_REFERENCE_MAPS")

pytestmark = pytest.mark.skipif(
    FOLDER is None,
    reason="MJDRIVE_REFERENCE_MAPS does not name a folder with CARLA's Town01.xodr and Town02.xodr",
)

Pair = tuple[Town, Town]


@pytest.fixture(scope="module", params=["town01", "town02"])
def pair(request: pytest.FixtureRequest) -> Pair:
    """Our town and CARLA's."""
    path = Path(FOLDER or "") / f"{request.param.capitalize()}.xodr"
    reference = build_town(
        opendrive.read(path), name=request.param, timing=LightTiming(), digest=""
    )
    return library.load(request.param), reference


def _by_ends(town: Town) -> dict[tuple[str, str], str]:
    """Lanes across junctions by the lanes before and behind them; the others by their names, which both maps share."""
    names = {}
    for lane in town.lanes.values():
        if lane.junction is None:
            names[lane.id, ""] = lane.id
            names |= {
                (lane.id, town.lanes[way].successors[0]): way
                for way in lane.successors
                if town.lanes[way].junction
            }
    return names


def _distances(pair: Pair) -> dict[str, float]:
    """Hausdorff distance [m] of each of our lanes from CARLA's."""
    ours, theirs = pair
    own, reference = _by_ends(ours), _by_ends(theirs)
    assert own.keys() == reference.keys()
    return {
        name: shapely.hausdorff_distance(
            shapely.LineString(ours.lanes[name].centerline),
            shapely.LineString(theirs.lanes[reference[key]].centerline),
        )
        for key, name in own.items()
    }


def test_every_centre_line_is_within_half_a_metre(pair: Pair) -> None:
    distances = _distances(pair)
    assert len(distances) == len(pair[0].lanes) == len(pair[1].lanes)
    assert max(distances.values()) < 0.3


def test_straights_are_within_five_centimetres(pair: Pair) -> None:
    lanes = pair[0].lanes
    streets = [
        name for name, lane in lanes.items() if lane.junction is None and lane_length(lane) > 25.0
    ]
    ways = [name for name, lane in lanes.items() if lane.move == Move.STRAIGHT]
    distances = _distances(pair)
    assert max(distances[name] for name in streets + ways) < 0.05


def test_lane_lengths_add_up_to_the_same(pair: Pair) -> None:
    ours, theirs = (sum(lane_length(lane) for lane in town.lanes.values()) for town in pair)
    assert ours == pytest.approx(theirs, rel=0.001)


def test_moves_are_the_same(pair: Pair) -> None:
    own, reference = (_by_ends(town) for town in pair)
    for key, name in own.items():
        assert pair[0].lanes[name].move == pair[1].lanes[reference[key]].move


def test_lights_stop_the_same_lanes_at_the_same_lines(pair: Pair) -> None:
    ours, theirs = pair
    assert ours.lights.keys() == theirs.lights.keys()
    for name, light in ours.lights.items():
        other = theirs.lights[name]
        assert (light.lane, light.junction, light.program, light.offset) == (
            other.lane,
            other.junction,
            other.program,
            other.offset,
        )
        np.testing.assert_allclose(light.stop_line, other.stop_line, atol=0.05)
        np.testing.assert_allclose(light.pole, other.pole, atol=0.4)
