import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mjdrive.bev.layers import Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.bev.rasters import LARGEST_RASTER, draw_area, draw_lanes, require_drawable
from mjdrive.config import BevConfig
from mjdrive.datatypes import Lane, Town
from mjdrive.errors import ConfigError, TownFormatError
from mjdrive.town import library

BENCH = Path(__file__).resolve().parents[3] / "scripts" / "bench" / "bev.py"


def layers_of(town: Town, **settings: object) -> list[np.ndarray]:
    """Road and lane lines of the whole town."""
    rasters = draw_lanes(town, BevConfig(**settings))
    shown = {
        channel: raster.image > threshold
        for raster in rasters
        for channel, threshold in raster.thresholds
    }
    return [shown[Layer.ROAD], shown[Layer.LANE_LINES]]


@pytest.mark.parametrize("name", ["town01", "town02"])
def test_views_are_byte_for_byte_those_of_one_plain_warp_a_channel(name):
    town = library.load(name)
    plain = runpy.run_path(str(BENCH))["PlainProjector"](town)
    projector = BevProjector(town)
    rng = np.random.default_rng(0)
    points = np.concatenate([lane.centerline for lane in town.lanes.values()])
    for _ in range(300):
        x, y = rng.choice(points) + rng.normal(0.0, 4.0, 2)
        yaw, time, phase = rng.uniform(-np.pi, np.pi), rng.uniform(0, 60), rng.uniform(0, 45)
        pose = {"x": x, "y": y, "yaw": yaw, "time": time, "light_phase": phase}
        np.testing.assert_array_equal(projector.project(**pose), plain.project(**pose))


@pytest.mark.parametrize(
    ("outline_px", "width_px"), [(0, 41), (1, 41), (3, 43), (5, 45), (7, 47), (9, 49)]
)
def test_outline_makes_the_road_as_much_wider_as_it_says(make_street, outline_px, width_px):
    # Two lanes of 4 m cover 41 px with both edges: 45 px, the paper's 9.0 m, need an outline of 5 px.
    road, _ = layers_of(make_street(), road_outline_px=outline_px)
    assert np.count_nonzero(road[:, road.shape[1] // 2]) == width_px


def test_outline_of_an_even_width_is_refused():
    with pytest.raises(ConfigError, match="odd"):
        BevConfig(road_outline_px=6)


def test_road_of_the_view_is_at_most_a_pixel_wider(make_street):
    projector = BevProjector(make_street(), config=BevConfig(road_outline_px=5))
    for yaw in np.radians(range(-40, 41, 10)):
        road = projector.project(x=0.03, y=0.07, yaw=yaw, time=0.0, light_phase=0.0)[Layer.ROAD]
        width = np.count_nonzero(road[100]) * np.cos(yaw)
        assert 44 <= width <= 47


def test_three_lane_lines_of_one_pixel_run_unbroken(make_street):
    _, lines = layers_of(make_street())
    columns = slice(*np.flatnonzero(lines.any(axis=0))[[0, -1]])
    rows = np.flatnonzero(lines.any(axis=1))
    np.testing.assert_array_equal(np.diff(rows), [20, 20])
    assert np.all(lines[rows, columns])


@settings(max_examples=30, deadline=None)
@given(yaw=st.floats(-0.7, 0.7), x=st.floats(-50, 50), y=st.floats(-3, 3))
def test_lane_lines_of_the_view_are_three_unbroken_and_one_to_three_pixels_wide(
    make_street, yaw, x, y
):
    bev = BevProjector(make_street()).project(x=x, y=y, yaw=yaw, time=0.0, light_phase=0.0)
    for row in bev[Layer.LANE_LINES, 60:180] > 0:
        edges = np.flatnonzero(np.diff(np.concatenate([[0], row, [0]])))
        starts, ends = edges[::2], edges[1::2]
        inner = (starts > 0) & (ends < 192)
        assert np.all((ends - starts)[inner] <= np.ceil(3 / np.cos(yaw)) + 1)
        gaps = np.diff((starts + ends)[inner] / 2) * np.cos(yaw)
        assert np.all(np.abs(gaps - 20) <= 2)  # none is missing between two others
        assert len(starts) >= 1


def test_junctions_have_no_lane_lines(make_street):
    town = make_street()
    lanes = {name: replace(lane, junction="j") for name, lane in town.lanes.items()}
    road, lines = layers_of(replace(town, lanes=lanes))
    assert road.any()
    assert not lines.any()


def test_outline_too_narrow_to_share_a_raster_draws_the_same_lines(make_street):
    apart = BevProjector(make_street(), config=BevConfig(road_outline_px=0))
    shared = BevProjector(make_street())
    assert len(draw_lanes(make_street(), BevConfig(road_outline_px=0))) == 2
    assert len(draw_lanes(make_street(), BevConfig())) == 1
    pose = {"x": 70.3, "y": 1.2, "yaw": 0.4, "time": 3.0, "light_phase": 0.0}
    one, other = apart.project(**pose), shared.project(**pose)
    np.testing.assert_array_equal(one[1:], other[1:])
    assert np.all(one[0] <= other[0])
    assert one[0].any()


def bare_town(*lanes: Lane) -> Town:
    points = np.concatenate([lane.centerline for lane in lanes])
    bounds = np.concatenate([points.min(axis=0) - 10, points.max(axis=0) + 10])
    return Town("bare", {lane.id: lane for lane in lanes}, {}, bounds, "")


def test_lanes_that_widen_are_drawn_as_wide_as_they_are():
    line = np.array([[0.0, 0.0], [50.0, 0.0], [100.0, 0.0]])
    lane = Lane("a", line, 4.0, (), None, None, widths=np.array([2.0, 4.0, 6.0]))
    _, lines = layers_of(bare_town(lane))
    for x, width in ((10, 2.4), (50, 4.0), (90, 5.6)):
        rows = np.flatnonzero(lines[:, round((x + 10 + 15) * 5)])
        assert np.ptp(rows) == pytest.approx(5 * width, abs=1)


def test_several_lanes_have_a_line_at_every_edge_whichever_side_traffic_keeps_to():
    east = np.array([[0.0, 0.0], [100.0, 0.0]])
    right_hand = {-5.25: east, -1.75: east, 1.75: east[::-1], 5.25: east[::-1]}
    left_hand = {offset: line[::-1] for offset, line in right_hand.items()}
    pictures = []
    for hand in (right_hand, left_hand):
        lanes = [
            Lane(str(offset), line + np.array([0.0, offset]), 3.5, (), None, None)
            for offset, line in hand.items()
        ]
        pictures.append(np.array(layers_of(bare_town(*lanes))))
    np.testing.assert_array_equal(*pictures)
    middle = pictures[0].shape[2] // 2
    rows = np.flatnonzero(pictures[0][1][:, middle])
    np.testing.assert_allclose(np.diff(rows), 3.5 * 5, atol=1)
    assert len(rows) == 5


def test_island_of_a_roundabout_is_no_road():
    angle = np.linspace(0, 2 * np.pi, 181)
    ring = 15.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    road, lines = layers_of(bare_town(Lane("ring", ring, 4.0, ("ring",), None, None)))
    centre = np.array(road.shape) // 2
    distance = np.hypot(*(np.indices(road.shape) - centre[:, None, None])) / 5
    assert not road[distance < 12].any()
    assert road[(distance > 13.2) & (distance < 16.8)].all()
    assert np.all(np.abs(np.abs(distance[lines] - 15) - 2) < 0.4)


def test_areas_keep_their_holes_and_overlaps(make_street):
    yard = shapely.box(0, 10, 40, 50) - shapely.box(10, 20, 30, 40)
    both = shapely.GeometryCollection([yard, shapely.box(35, 10, 60, 50)])
    raster = draw_area(make_street(), both, 5, BevConfig())
    raster_from_world = np.linalg.inv(raster.world_from_raster)
    for point, expected in (((5, 30), 255), ((20, 30), 0), ((37, 30), 255), ((50, 30), 255)):
        column, row, _ = np.rint(raster_from_world @ [*point, 1.0]).astype(int)
        assert raster.image[row, column] == expected


def test_towns_too_large_to_draw_are_refused_before_any_memory_is_taken():
    def diagonal(side: float) -> Town:
        line = np.array([[0.0, 0.0], [side, side]])
        return bare_town(Lane("a", line, 4.0, (), None, None))

    largest = np.sqrt(LARGEST_RASTER) / 5 - 2 * (10 + 15)  # margins of the bounds and of the raster
    require_drawable(diagonal(largest - 0.5))
    with pytest.raises(TownFormatError, match="expected 200 million or fewer"):
        require_drawable(diagonal(largest + 0.5))
    with pytest.raises(TownFormatError, match=r"covers 100050 m by 100050 m.*Cut the map"):
        draw_lanes(diagonal(100_000.0), BevConfig())  # 250 GB
    require_drawable(diagonal(2 * largest), BevConfig(pixels_per_metre=2.5))
