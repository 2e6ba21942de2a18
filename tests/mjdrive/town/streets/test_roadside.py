import numpy as np
import pytest

from mjdrive.town.opendrive.reference_line import reference_line
from mjdrive.town.opendrive.road_map import LaneRecord, LaneSection, Road
from mjdrive.town.streets.fillet import Pose, length_of, turn_left
from mjdrive.town.streets.roadside import sign_signal
from mjdrive.town.streets.street_builder import build_map
from mjdrive.town.streets.street_plan import JunctionPlan, LightPlan, SpeedSignPlan, StreetPlan


@pytest.fixture
def bend() -> Road:
    """A quarter circle to the left."""
    pieces = turn_left(Pose(np.zeros(2), np.array([1.0, 0.0])), radius=50.0, angle=np.pi / 2)
    section = LaneSection(0.0, (LaneRecord(0, "none"),))
    return Road("1", "", length_of(pieces), None, pieces, (), (section,))


@pytest.mark.parametrize(("t", "lane", "orientation"), [(-4.5, -1, "+"), (4.5, 1, "-")])
def test_a_sign_is_for_the_traffic_on_its_side(
    bend: Road, t: float, lane: int, orientation: str
) -> None:
    (point,), (heading,) = reference_line(bend.pieces, np.array([30.0]))
    x, y = point + t * np.array([-np.sin(heading), np.cos(heading)])
    signal = sign_signal(SpeedSignPlan("s", "1", 50.0, (float(x), float(y))), bend)
    assert (signal.from_lane, signal.to_lane, signal.orientation) == (lane, lane, orientation)
    assert (signal.type, signal.value, signal.unit) == ("274", 50.0, "km/h")
    assert not signal.dynamic
    assert signal.t == pytest.approx(t, abs=1e-3)
    assert signal.s == pytest.approx(30.0, abs=0.01)


def test_a_light_without_a_pole_stands_behind_the_kerb_at_the_stop_line(plan: StreetPlan) -> None:
    crossing = plan.junctions["20"]
    lights = tuple(LightPlan(light.road, light.id) for light in crossing.lights)
    crossing = JunctionPlan(crossing.arms, lights, crossing.turns)
    roads = build_map(
        StreetPlan(
            plan.name, plan.nodes, plan.streets, plan.corners, {**plan.junctions, "20": crossing}
        )
    ).roads
    (ends_here,), (begins_here,) = roads["1"].signals, roads["2"].signals
    assert (ends_here.s, ends_here.t) == (roads["1"].length, -4.7)
    assert (begins_here.s, begins_here.t) == (0.0, 4.7)
