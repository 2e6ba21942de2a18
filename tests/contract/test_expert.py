"""The expert is what everything is learnt from: it must drive well, on every route of the study."""

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.datatypes import Route, Town
from mjdrive.episodes.collection import collect_route
from mjdrive.episodes.driving import drive_expert
from mjdrive.episodes.presets import collect_preset
from mjdrive.evaluation.metrics import summarise
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing

ROUTES = tuple(library.load_settings("town01").routes)


@pytest.fixture(scope="module")
def simulation01(town01: Town) -> Simulation:
    return Simulation(town01)


def offsets_on_streets(town: Town, route: Route, positions: np.ndarray) -> np.ndarray:
    """Distance from the route of each position outside junctions [m]."""
    found, segment = [], 0
    for position in positions:
        seen = geometry.project(
            route.points, position, first_segment=max(segment - 2, 0), last_segment=segment + 15
        )
        segment = seen.segment
        if town.lanes[route.lanes[route.lane_index[segment]]].junction is None:
            found.append(abs(seen.offset))
    return np.array(found)


def test_the_study_has_ten_routes() -> None:
    assert len(ROUTES) == 10


@pytest.mark.parametrize("name", ROUTES)
def test_route_is_finished_cleanly_and_within_the_lane(
    name: str, town01: Town, simulation01: Simulation
) -> None:
    waypoints = np.array(library.load_settings("town01").routes[name])
    route = routing.route_through(town01, waypoints)
    episode = collect_route(simulation01, route, config=collect_preset("paper"), seed=0)
    assert episode.infractions == ()
    assert episode.on_lane.all()
    assert offsets_on_streets(town01, route, episode.vehicle[:, :2]).max() < 0.6


def test_free_drive_through_town02_is_clean_and_gets_far(
    town02: Town, simulation: Simulation
) -> None:
    summary = summarise(drive_expert(simulation, num_steps=3000, seed=0), town02)
    assert (summary.red_lights, summary.collisions, summary.off_road_s) == (0, 0, 0.0)
    assert summary.distance_m > 900


def test_free_drive_through_town03_is_clean_on_its_roundabout_too() -> None:
    town = library.load("town03")
    episode = drive_expert(Simulation(town), num_steps=700, seed=1)
    assert episode.infractions == ()
    ring = [lane.centerline for lane in town.lanes.values() if lane.id.startswith("600")]
    gaps = np.hypot(*(np.concatenate(ring)[:, None] - episode.vehicle[None, :, :2]).T)
    assert gaps.min() < 0.5, "expected the drive to lead round the ring"
