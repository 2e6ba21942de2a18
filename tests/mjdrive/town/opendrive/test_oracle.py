"""Maps written by another program, scenariogeneration, are read as it meant them."""

from pathlib import Path

import numpy as np
import pytest
from scenariogeneration import xodr

from mjdrive.town import opendrive
from mjdrive.town.network import build_town
from mjdrive.town.opendrive.reference_line import reference_line
from mjdrive.town.opendrive.road_map import RoadMap
from mjdrive.town.settings import LightTiming


def _read(document: xodr.OpenDrive, folder: Path) -> RoadMap:
    path = folder / "map.xodr"
    document.write_xml(str(path))
    return opendrive.read(path)


@pytest.mark.parametrize(
    "shape",
    [
        xodr.Line(40.0),
        xodr.Arc(0.05, length=30.0),
        xodr.Spiral(1e-9, 0.1, length=25.0),
        xodr.Spiral(-0.1, 0.08, length=40.0),
        xodr.ParamPoly3(0, 20, 0, 2, 0, 0, 5, -3, "normalized"),
    ],
)
def test_reference_lines_end_where_the_writer_says(
    shape: xodr.Line | xodr.Arc | xodr.Spiral | xodr.ParamPoly3, tmp_path: Path
) -> None:
    road = xodr.create_road([xodr.Line(10.0), shape], 0, 1, 1)
    document = xodr.OpenDrive("one road")
    document.add_road(road)
    document.adjust_roads_and_lanes()
    read = _read(document, tmp_path).roads["0"]
    (point,), (heading,) = reference_line(read.pieces, np.array([read.length]))
    x, y, yaw = road.planview.get_end_point()
    np.testing.assert_allclose(point, (x, y), atol=1e-4)
    assert np.cos(heading - yaw) == pytest.approx(1.0, abs=1e-8)


def test_a_crossing_of_four_roads_is_driven_in_all_directions(tmp_path: Path) -> None:
    roads = [xodr.create_road(xodr.Line(50.0), number, 1, 1) for number in range(4)]
    junction = xodr.CommonJunctionCreator(id=100, name="crossing", startnum=100)
    for number, road in enumerate(roads):
        junction.add_incoming_road_circular_geometry(
            road, radius=20.0, angle=number * np.pi / 2, road_connection="successor"
        )
    for one in range(4):
        for other in range(one):
            junction.add_connection(one, other)
    document = xodr.OpenDrive("crossing")
    for road in roads:
        document.add_road(road)
    document.add_junction_creator(junction)
    document.adjust_roads_and_lanes()
    road_map = _read(document, tmp_path)
    town = build_town(road_map, name="crossing", timing=LightTiming(), digest="")
    entries = [lane for lane in town.lanes.values() if lane.successors and lane.junction is None]
    assert len(entries) == 4
    for lane in entries:
        assert {town.lanes[name].move.name for name in lane.successors} == {
            "LEFT",
            "STRAIGHT",
            "RIGHT",
        }


def test_a_direct_junction_leads_to_both_roads(tmp_path: Path) -> None:
    main = xodr.create_road(xodr.Line(50.0), 1, left_lanes=0, right_lanes=2)
    ahead = xodr.create_road(xodr.Line(50.0), 2, left_lanes=0, right_lanes=1)
    ramp = xodr.create_road(xodr.Spiral(-1e-5, -0.02, length=50.0), 3, left_lanes=0, right_lanes=1)
    junction = xodr.DirectJunctionCreator(id=400, name="exit")
    main.add_successor(xodr.ElementType.junction, junction.id)
    ahead.add_predecessor(xodr.ElementType.junction, junction.id)
    ramp.add_predecessor(xodr.ElementType.junction, junction.id)
    junction.add_connection(main, ahead, [-1], [-1])
    junction.add_connection(main, ramp, [-2], [-1])
    document = xodr.OpenDrive("exit")
    for road in (main, ahead, ramp):
        document.add_road(road)
    document.add_junction_creator(junction)
    document.adjust_roads_and_lanes()
    town = build_town(_read(document, tmp_path), name="exit", timing=LightTiming(), digest="")
    assert town.lanes["1/0/-1"].successors == ("2/0/-1",)
    assert town.lanes["1/0/-2"].successors == ("3/0/-1",)
