import dataclasses

import numpy as np
import pytest

from mjdrive.datatypes import Episode, Town
from mjdrive.episodes.driving import drive_expert
from mjdrive.evaluation import lane_keeping
from mjdrive.evaluation.coverage import Coverage, coverage, reachable_lanes
from mjdrive.simulation.simulation import Simulation


@pytest.fixture(scope="module")
def walk(town02: Town) -> Episode:
    return drive_expert(Simulation(town02), num_steps=600, seed=3)


def test_every_directed_street_of_town02_can_be_reached(town02: Town) -> None:
    streets = [name for name, lane in town02.lanes.items() if lane.junction is None]
    assert set(reachable_lanes(town02)) == set(streets)


def test_lanes_are_counted_once_where_they_are_first_driven(walk: Episode, town02: Town) -> None:
    lanes = lane_keeping.track(walk, town02)
    driven = {name for name in lanes.lane if name and town02.lanes[name].junction is None}
    found = coverage([(walk, lanes)], town02)
    assert found.share[-1] * found.lanes == pytest.approx(len(driven))
    twice = coverage([(walk, lanes), (walk, lanes)], town02)
    np.testing.assert_array_equal(twice.share, found.share)
    assert twice.distance_km[-1] == pytest.approx(2 * found.distance_km[-1])


def test_driving_against_the_lane_covers_nothing(walk: Episode, town02: Town) -> None:
    lanes = lane_keeping.track(walk, town02)
    backwards = dataclasses.replace(lanes, heading_error=np.full(len(walk.time), np.pi))
    assert coverage([(walk, backwards)], town02).share[-1] == 0.0


def test_distances_to_a_share_and_the_area_below_the_curve() -> None:
    found = Coverage(
        distance_km=np.array([0.0, 1.0, 2.0, 4.0]), share=np.array([0.0, 0.5, 1.0, 1.0]), lanes=2
    )
    assert (found.km_to(0.5), found.km_to(0.9), found.km_to(1.0)) == (1.0, 2.0, 2.0)
    assert found.mean_share(2.0) == pytest.approx(0.25)
    assert found.mean_share(4.0) == pytest.approx((0.5 + 2.0) / 4.0)
    assert found.mean_share(8.0) == pytest.approx((0.5 + 2.0 + 4.0) / 8.0)


def test_share_that_is_never_reached_has_no_distance() -> None:
    found = Coverage(distance_km=np.array([0.0, 3.0]), share=np.array([0.0, 0.0]), lanes=5)
    assert found.km_to(0.5) is None
