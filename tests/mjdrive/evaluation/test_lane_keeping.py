import dataclasses
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.datatypes import Episode, Town
from mjdrive.episodes import store
from mjdrive.evaluation import lane_keeping
from mjdrive.town import routing

Make = Callable[..., Episode]


def figures_of(drive: Episode, town: Town) -> lane_keeping.LaneKeeping:
    return lane_keeping.summarise(drive, lane_keeping.track(drive, town))


def test_frenet_coordinates_of_a_straight_drive(crossing: Town, make_drive: Make) -> None:
    x = np.linspace(5.0, 35.0, 61)
    lanes = lane_keeping.track(make_drive(x, y=0.7, yaw=0.1), crossing)
    assert lanes.lane == ("west",) * 61
    np.testing.assert_allclose(lanes.station, x)
    np.testing.assert_allclose(lanes.offset, 0.7)
    np.testing.assert_allclose(lanes.heading_error, 0.1)
    assert not lanes.in_junction.any()


def test_figures_of_a_sine_are_those_of_the_textbook(crossing: Town, make_drive: Make) -> None:
    x = np.linspace(2.0, 38.0, 3601)  # nine whole waves
    summary = figures_of(make_drive(x, y=0.5 * np.sin(np.pi * x / 2)), crossing)
    assert summary.offset_mean_m == pytest.approx(0.5 * 2 / np.pi, abs=1e-3)
    assert summary.offset_rms_m == pytest.approx(0.5 / np.sqrt(2), abs=1e-3)
    assert summary.offset_p95_m == pytest.approx(0.5 * np.sin(0.95 * np.pi / 2), abs=1e-3)
    assert summary.heading_error_rms_rad == 0.0
    assert summary.junction_offset_mean_m is None


@pytest.mark.parametrize("side", [1.0, -1.0], ids=["left", "right"])
def test_offset_and_heading_error_are_positive_to_the_left(
    crossing: Town, make_drive: Make, side: float
) -> None:
    lanes = lane_keeping.track(make_drive([10.0], y=side * 0.3, yaw=side * 0.2), crossing)
    assert lanes.offset == pytest.approx([side * 0.3])
    assert lanes.heading_error == pytest.approx([side * 0.2])


def test_either_way_through_a_junction_is_as_good(crossing: Town, make_drive: Make) -> None:
    angle = np.linspace(0.05, np.pi / 2 - 0.05, 60)
    left = make_drive(40 + 20 * np.sin(angle), y=20 - 20 * np.cos(angle), yaw=angle)
    straight = make_drive(np.linspace(41.0, 59.0, 60))
    assert figures_of(straight, crossing).junction_offset_mean_m == pytest.approx(0.0, abs=1e-6)
    # The lane is a polygon of eight chords, so the arc is up to 0.1 m beside it.
    assert figures_of(left, crossing).junction_offset_mean_m == pytest.approx(0.0, abs=0.1)
    assert figures_of(left, crossing).offset_mean_m is None


def test_standing_and_being_off_the_road_do_not_count(crossing: Town, make_drive: Make) -> None:
    x = np.concatenate([np.linspace(1.0, 20.0, 40), np.full(100, 20.0), np.linspace(20.5, 35, 30)])
    y = np.where(np.arange(len(x)) < 40, 0.2, 1.5)
    on_lane = np.arange(len(x)) < 140
    summary = figures_of(make_drive(x, y=y, on_lane=on_lane), crossing)
    moving = 38 * [0.2] + [0.2, 1.5]  # the step on which y changes moves, too
    assert summary.offset_mean_m == pytest.approx(np.mean(moving), abs=0.02)


def test_far_from_every_lane_there_is_no_offset(crossing: Town, make_drive: Make) -> None:
    lanes = lane_keeping.track(make_drive([0.0, 500.0], y=np.array([0.0, 500.0])), crossing)
    assert lanes.lane == ("west", "")
    assert np.isnan([lanes.station[1], lanes.offset[1], lanes.heading_error[1]]).all()


@pytest.mark.parametrize("steps", [0, 1])
def test_short_drives_have_no_figures(crossing: Town, make_drive: Make, steps: int) -> None:
    summary = figures_of(make_drive(np.zeros(steps)), crossing)
    assert set(dataclasses.asdict(summary).values()) == {None}


def test_moving_the_world_changes_nothing(crossing: Town, make_drive: Make) -> None:
    x = np.linspace(1.1, 59.3, 80)  # on no seam between two lanes
    drive = make_drive(x, y=0.3 * np.sin(x), yaw=0.1 * np.cos(x))
    motion = {"x": 1000.0, "y": -300.0, "yaw": 2.0}
    lanes = {
        name: dataclasses.replace(
            lane, centerline=geometry.world_from_vehicle(lane.centerline, **motion)
        )
        for name, lane in crossing.lanes.items()
    }
    vehicle = drive.vehicle.copy()
    vehicle[:, :2] = geometry.world_from_vehicle(vehicle[:, :2], **motion)
    vehicle[:, 2] += motion["yaw"]
    before = lane_keeping.track(drive, crossing)
    after = lane_keeping.track(
        dataclasses.replace(drive, vehicle=vehicle), dataclasses.replace(crossing, lanes=lanes)
    )
    assert before.lane == after.lane
    for field in ("station", "offset", "heading_error"):
        np.testing.assert_allclose(getattr(before, field), getattr(after, field), atol=1e-8)


def test_outside_junctions_the_lane_is_that_of_the_router(town02: Town, make_drive: Make) -> None:
    rng = np.random.default_rng(5)
    low, high = town02.bounds[:2], town02.bounds[2:]
    points, yaw = rng.uniform(low, high, (400, 2)), rng.uniform(-np.pi, np.pi, 400)
    lanes = lane_keeping.track(make_drive(points[:, 0], y=points[:, 1], yaw=yaw), town02)
    compared = 0
    for row, name in enumerate(lanes.lane):
        if name and not lanes.in_junction[row] and abs(lanes.offset[row]) < 5.0:
            expected, place = routing.nearest_lane(town02, points[row], yaw=yaw[row])
            assert name == expected
            assert lanes.station[row] == pytest.approx(place.station, abs=1e-6)
            assert lanes.offset[row] == pytest.approx(place.offset, abs=1e-6)
            compared += 1
    assert compared > 50


def test_keeping_to_a_route_keeps_to_the_lanes(town02: Town, make_drive: Make) -> None:
    drive = route_drive(town02, make_drive, num_steps=500)
    summary = figures_of(drive, town02)
    assert summary.offset_p95_m is not None
    assert summary.offset_p95_m < 0.05  # points 1 m apart cut corners a little
    assert summary.junction_offset_mean_m is not None
    assert summary.junction_offset_mean_m < 0.05


def test_five_minutes_of_driving_take_less_than_a_second(
    town02: Town, make_drive: Make, tmp_path: Path
) -> None:
    store.write(route_drive(town02, make_drive, num_steps=3000), tmp_path / "drive.hdf5")
    program = (  # in a process of its own, where no types are checked
        "import pathlib, time; from mjdrive.episodes import store; from mjdrive.town import library; "
        "from mjdrive.evaluation import lane_keeping; town = library.load('town02'); "
        "drive = store.read(pathlib.Path('drive.hdf5')); begin = time.process_time(); "
        "lane_keeping.track(drive, town); print(time.process_time() - begin)"
    )
    command = [sys.executable, "-c", program]
    other = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert float(other.stdout) < 1.0


def route_drive(town: Town, make_drive: Make, *, num_steps: int) -> Episode:
    """A drive along the centres of the lanes, 0.6 m a step."""
    rng = np.random.default_rng(0)
    lane, _ = routing.random_start(town, rng)
    length = 0.6 * num_steps
    route = routing.random_route(town, lane=lane, station=0.0, length=length, rng=rng)
    along = np.linspace(0.0, length, num_steps)
    columns = (*route.points.T, np.unwrap(route.yaw))
    x, y, yaw = (np.interp(along, route.station, column) for column in columns)
    return make_drive(x, y=y, yaw=yaw)
