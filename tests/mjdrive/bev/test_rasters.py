from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mjdrive.benchmarks.naive_bev import PlainProjector
from mjdrive.bev.layers import Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.bev.rasters import (
    LARGEST_RASTER,
    draw_areas,
    draw_lanes,
    lane_layers,
    require_drawable,
)
from mjdrive.config import BevConfig
from mjdrive.datatypes import Lane, Town
from mjdrive.errors import ConfigError, TownFormatError
from mjdrive.town import library


def layers_of(town: Town, **settings: object) -> list[np.ndarray]:
    """Road and lane lines of the whole town, as they are drawn."""
    layers, _ = lane_layers(town, BevConfig(**settings))
    return [layers[Layer.ROAD] > 0, layers[Layer.LANE_LINES] > 0]


def random_poses(town: Town, count: int) -> list[dict[str, float]]:
    rng = np.random.default_rng(0)
    points = np.concatenate([lane.centerline for lane in town.lanes.values()])
    poses = []
    for _ in range(count):
        x, y = rng.choice(points) + rng.normal(0.0, 4.0, 2)
        poses.append({"x": float(x), "y": float(y), "yaw": float(rng.uniform(-np.pi, np.pi))})
    return poses


@pytest.mark.parametrize("name", ["town01", "town02"])
def test_a_pixel_of_the_view_shows_what_any_of_the_four_drawn_pixels_around_it_shows(name):
    town = library.load(name)
    projector = BevProjector(town)
    layers, world_from_drawn = lane_layers(town, BevConfig())
    rows, columns = np.indices((192, 192)).reshape(2, -1)
    for pose in random_poses(town, 30):
        bev = projector.project(**pose, time=0.0, light_phase=0.0)
        view_from_drawn = projector.view_from_world(**pose) @ world_from_drawn
        places = np.linalg.inv(view_from_drawn) @ [columns, rows, np.ones(192 * 192)]
        # Closer than this to the middle of a drawn pixel, rounding decides which four they are.
        is_clear = np.abs(places[:2] - np.rint(places[:2])).min(axis=0) > 1e-3
        left, top = np.floor(places[:2]).astype(int)
        for channel, layer in layers.items():
            inside = (
                (left >= 0) & (top >= 0) & (left < layer.shape[1] - 1) & (top < layer.shape[0] - 1)
            )
            check = is_clear & inside
            four = [layer[top[check] + y, left[check] + x] for y in (0, 1) for x in (0, 1)]
            np.testing.assert_array_equal(bev[channel].ravel()[check], np.max(four, axis=0))


@pytest.mark.parametrize("name", ["town01", "town02"])
def test_views_are_those_of_one_plain_warp_a_channel_but_for_single_pixels(name):
    # The plain way rounds to 8 bits, so a pixel that is touched by less than 1/510 of its weight stays dark there.
    town = library.load(name)
    plain = PlainProjector(town)
    projector = BevProjector(town)
    rng = np.random.default_rng(0)
    for pose in random_poses(town, 300):
        when = {"time": rng.uniform(0, 60), "light_phase": rng.uniform(0, 45)}
        ours, theirs = projector.project(**pose, **when), plain.project(**pose, **when)
        np.testing.assert_array_equal(ours[2:], theirs[2:])
        assert np.all(ours[:2] >= theirs[:2])
        assert np.count_nonzero(ours != theirs) <= 0.01 * np.count_nonzero(ours[:2])


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


def test_lane_lines_do_not_depend_on_the_outline_of_the_road(make_street):
    bare = BevProjector(make_street(), config=BevConfig(road_outline_px=0))
    outlined = BevProjector(make_street())
    pose = {"x": 70.3, "y": 1.2, "yaw": 0.4, "time": 3.0, "light_phase": 0.0}
    one, other = bare.project(**pose), outlined.project(**pose)
    np.testing.assert_array_equal(one[1:], other[1:])
    assert np.all(one[0] <= other[0])
    assert np.count_nonzero(one[0]) < np.count_nonzero(other[0])


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
    raster = draw_areas(make_street(), {5: both, 6: shapely.box(10, 20, 20, 30)}, BevConfig())
    assert raster.channels == (5, 6)
    raster_from_world = np.linalg.inv(raster.world_from_raster)
    for point, expected in (
        ((5, 30), 1),
        ((15, 25), 2),
        ((25, 35), 0),
        ((37, 30), 1),
        ((50, 30), 1),
    ):
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
