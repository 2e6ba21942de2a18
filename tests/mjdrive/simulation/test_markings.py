from dataclasses import replace

import mujoco
import numpy as np
import pytest
import shapely

from mjdrive.datatypes import Lane, Marking, Signal, Town, TrafficLight
from mjdrive.geometry import stations
from mjdrive.simulation.markings import add_markings, centre_lines, painted, stop_bars, zebra
from mjdrive.simulation.palette import add_materials
from mjdrive.town.opendrive.vocabulary import MARK_COLORS


def lane(name: str, points: list[list[float]], *, junction: str | None = None) -> Lane:
    return Lane(
        id=name,
        centerline=np.array(points),
        width=4.0,
        successors=(),
        junction=junction,
        light=None,
    )


@pytest.fixture
def street() -> Town:
    """Two opposite lanes along the x axis and one in a junction; a light ends the eastbound one."""
    lanes = [
        lane("east", [[0.0, -2.0], [60.0, -2.0]]),
        lane("west", [[60.0, 2.0], [0.0, 2.0]]),
        lane("crossing", [[60.0, -2.0], [75.0, -2.0]], junction="1"),
    ]
    light = TrafficLight(
        id="1",
        lane="east",
        junction="1",
        stop_line=np.array([[60.0, 0.0], [60.0, -4.0]]),
        yaw=0.0,
        pole=np.array([60.0, -5.0]),
        program=((Signal.GREEN, 1.0),),
        offset=0.0,
    )
    return Town(
        name="street",
        lanes={each.id: each for each in lanes},
        lights={"1": light},
        bounds=np.array([0.0, -4.0, 75.0, 4.0]),
        digest="",
    )


def test_map_without_paint_gets_one_line_between_opposite_lanes(street):
    (line,) = centre_lines(street)
    assert line.points[:, 1] == pytest.approx(0.0)
    assert stations(line.points)[-1] == pytest.approx(60.0)


def test_left_hand_traffic_gets_the_same_line(street):
    lanes = {
        name: replace(lane, centerline=lane.centerline[::-1]) for name, lane in street.lanes.items()
    }
    (line,) = centre_lines(replace(street, lanes=lanes))
    assert line.points[:, 1] == pytest.approx(0.0)


def test_broken_line_is_cut_into_dashes_of_the_given_length_and_gap():
    line = Marking(np.array([[0.0, 0.0], [4.0, 0.0], [20.0, 0.0]]), 0.12, dash=3.0, gap=5.0)
    dashes = [piece[[0, -1], 0].tolist() for piece in painted(line)]
    assert dashes == [[0.0, 3.0], [8.0, 11.0], [16.0, 19.0]]


def test_unbroken_line_is_one_piece_that_follows_its_bends():
    bend = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]])
    (piece,) = painted(Marking(bend, 0.12))
    assert piece == pytest.approx(bend)


def paint(town: Town) -> mujoco.MjModel:
    spec = mujoco.MjSpec()
    add_materials(spec)
    add_markings(spec, town)
    return spec.compile()


def test_paint_of_the_map_has_its_colour_and_covers_its_length_times_width(street):
    line = Marking(np.array([[0.0, 1.0], [50.0, 1.0]]), 0.2, color="yellow")
    model = paint(replace(street, markings=(line,)))
    names = {model.geom(index).name for index in range(model.ngeom)}
    assert names == {"marking_yellow", "stop_bars"}
    assert painted_area(model, "marking_yellow") == pytest.approx(50.0 * 0.2, abs=0.05)


def test_paint_that_a_map_gives_twice_is_drawn_once(street):
    line = Marking(np.array([[0.0, 1.0], [50.0, 1.0]]), 0.2)
    once, twice = (paint(replace(street, markings=(line,) * count)) for count in (1, 2))
    assert painted_area(twice, "marking_white") == pytest.approx(
        painted_area(once, "marking_white")
    )


def painted_area(model: mujoco.MjModel, name: str) -> float:
    mesh = model.mesh(name)
    points = model.mesh_vert[mesh.vertadr[0] :][: mesh.vertnum[0]]
    faces = model.mesh_face[mesh.faceadr[0] :][: mesh.facenum[0]]
    corners = points[faces]
    sides = corners[:, 1:] - corners[:, :1]
    return float(0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum())


def test_crosswalk_is_striped_along_the_traffic_and_half_covered(street):
    stripes = zebra(shapely.box(20.0, -4.0, 24.0, 4.0), street)
    assert stripes.area == pytest.approx(0.5 * 4.0 * 8.0, rel=0.1)
    for stripe in stripes.geoms:
        left, bottom, right, top = stripe.bounds
        assert right - left == pytest.approx(4.0)
        assert top - bottom <= 0.5 + 1e-9


def test_stop_bar_lies_on_the_lane_before_the_stop_line(street):
    (bar,) = stop_bars(street)
    approach = shapely.box(0.0, -4.0, 60.0, 0.0)
    assert approach.buffer(1e-9).contains(shapely.Polygon(bar))
    assert bar[:, 0].max() == pytest.approx(60.0)


def test_stop_bars_face_the_sky(street):
    for quad in stop_bars(street):
        assert shapely.LinearRing(quad).is_ccw


@pytest.mark.parametrize("color", sorted(MARK_COLORS - {"standard"}))
def test_every_color_of_opendrive_can_be_painted(street, color):
    line = Marking(np.array([[0.0, 0.0], [4.0, 0.0]]), 0.12, color=color)
    spec = mujoco.MjSpec()
    add_materials(spec)
    add_markings(spec, replace(street, markings=(line,)))
    model = spec.compile()
    material = model.material(int(model.geom(f"marking_{color}").matid[0]))
    assert material.name == f"{color}_paint"
