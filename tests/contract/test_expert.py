"""The experts are what everything is learnt from: they must drive well, on every route of the study."""

import dataclasses

import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.config import CollectConfig, ExpertName, PidConfig
from mjdrive.datatypes import Episode, Route, Signal, Town, TrafficLight
from mjdrive.episodes.collection import collect_route, expert_of
from mjdrive.episodes.driving import drive_expert
from mjdrive.episodes.presets import collect_preset
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute
from mjdrive.evaluation.light_behaviour import LightPassage, is_rash, light_passages
from mjdrive.evaluation.metrics import summarise
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing
from mjdrive.town.lane_graph import lane_length
from mjdrive.town.route_line import lay
from mjdrive.vehicle import cars

# A route takes 20 s on a core of its own, and many times that where others want it.
pytestmark = pytest.mark.timeout(900)

LATEST_START = 1.0
LATE_BRAKING = PidConfig().late_braking
RUN_UP = 45.0  # from rest to the target speed and the stop line [m]

ROUTES = [
    (town, name) for town in ("town01", "town02") for name in library.load_settings(town).routes
]
# Light seeds are spread over the routes; `scripts/check_experts.py` drives every route under every one.
PID_DRIVES = [(town, name, seed) for seed, (town, name) in enumerate(ROUTES)]
MPC_DRIVES = [("town01", "route4", 3), ("town02", "route5", 1)]


@pytest.fixture(scope="module")
def simulations(town01: Town, simulation: Simulation) -> dict[str, Simulation]:
    return {"town01": Simulation(town01), "town02": simulation}


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


def passages(simulation: Simulation, episode: Episode, route: Route) -> tuple[LightPassage, ...]:
    car = simulation.car.parameters
    return light_passages(
        episode, simulation.town, route, nose_ahead=car.length - car.rear_overhang
    )


def require_flawless(simulation: Simulation, name: str, seed: int, expert: ExpertName) -> None:
    """Drive a route undisturbed and look at every step and every light of it."""
    town = simulation.town
    route = routing.route_through(town, np.array(library.load_settings(town.name).routes[name]))
    settings = dataclasses.replace(collect_preset("paper"), expert=expert)
    episode = collect_route(simulation, route, config=settings, seed=seed)
    assert episode.policy == expert
    assert episode.infractions == ()
    assert episode.on_lane.all()
    offsets = offsets_on_streets(town, route, episode.vehicle[:, :2])
    assert offsets.max() < 0.6
    assert np.sqrt(np.mean(offsets**2)) < 0.25
    met = passages(simulation, episode, route)
    assert met, "expected lights on the way"
    assert not [passage for passage in met if is_rash(passage, late_braking=LATE_BRAKING)]
    assert max(passage.start_delay or 0.0 for passage in met) <= LATEST_START


def test_the_study_has_ten_routes_and_six_to_test_on() -> None:
    assert [town for town, _ in ROUTES] == ["town01"] * 10 + ["town02"] * 6


@pytest.mark.parametrize(("town", "name", "seed"), PID_DRIVES)
def test_pid_drives_every_route_without_a_flaw(
    town: str, name: str, seed: int, simulations: dict[str, Simulation]
) -> None:
    require_flawless(simulations[town], name, seed, "pid")


@pytest.mark.parametrize(("town", "name", "seed"), MPC_DRIVES)
def test_mpc_drives_without_a_flaw(
    town: str, name: str, seed: int, simulations: dict[str, Simulation]
) -> None:
    require_flawless(simulations[town], name, seed, "mpc")


def approach(simulation: Simulation) -> tuple[Route, TrafficLight]:
    """A way up to a light and straight on."""
    town = simulation.town
    for light in town.lights.values():
        lane = town.lanes[light.lane]
        ways = [name for name in lane.successors if town.lanes[name].move.name == "STRAIGHT"]
        if ways and lane_length(lane) > RUN_UP:
            after = town.lanes[ways[0]].successors[0]
            chain = [lane.id, ways[0], after]
            return lay(town, chain, start=lane_length(lane) - RUN_UP, end=20.0), light
    raise AssertionError("no such light")


def drive_to_yellow(
    simulation: Simulation, route: Route, light: TrafficLight, expert: ExpertName, yellow_at: float
) -> Episode:
    """Drive up to a light that turns yellow so long after the start [s]."""
    x, y = route.points[0]
    simulation.place(x=float(x), y=float(y), yaw=float(route.yaw[0]), seed=0)
    green = dict(light.program)[Signal.GREEN]
    simulation.light_phase = green - light.offset - yellow_at + 0.05  # seen in the next step
    follow = FollowRoute(route)
    return rollout(
        simulation,
        expert_of(CollectConfig(expert=expert), simulation),
        follow,
        num_steps=170,
        seed=0,
        stop=lambda: follow.is_finished,
    )


@pytest.mark.parametrize("expert", ["pid", "mpc"])
def test_yellow_is_passed_only_by_who_cannot_stop_any_more(
    expert: ExpertName, simulation: Simulation
) -> None:
    route, light = approach(simulation)
    nose = simulation.car.parameters.length - simulation.car.parameters.rear_overhang
    freely = drive_to_yellow(simulation, route, light, expert, 9.9)
    outcomes = []
    for distance in (9.0, 6.0, 4.5, 4.0, 2.8, 1.5):
        along = np.hypot(*(freely.vehicle[:, :2] - route.points[0]).T)
        step = int(np.searchsorted(along, RUN_UP - nose - distance))
        episode = drive_to_yellow(simulation, route, light, expert, float(freely.time[step]))
        met = passages(simulation, episode, route)
        assert not [it for it in met if is_rash(it, late_braking=LATE_BRAKING)], distance
        assert episode.infractions == ()
        outcomes.append(bool(met))
    assert outcomes == [False, False, False, False, True, True]


def test_free_drive_through_town02_is_clean_and_gets_far(
    town02: Town, simulation: Simulation
) -> None:
    summary = summarise(drive_expert(simulation, num_steps=3000, seed=0), town02)
    assert (summary.red_lights, summary.collisions, summary.off_road_s) == (0, 0, 0.0)
    assert summary.distance_m > 900


@pytest.mark.parametrize("expert", ["pid", "mpc"])
def test_shorter_free_drive_is_the_beginning_of_the_longer(
    expert: ExpertName, simulation: Simulation
) -> None:
    settings = CollectConfig(expert=expert)
    short = drive_expert(simulation, num_steps=120, seed=2, config=settings)
    long = drive_expert(simulation, num_steps=240, seed=2, config=settings)
    np.testing.assert_array_equal(long.vehicle[:120], short.vehicle)
    np.testing.assert_array_equal(long.actions[:120], short.actions)


@pytest.mark.parametrize("car", cars.SHIPPED)
def test_car_that_stands_askew_drives_on(car: str, simulation: Simulation) -> None:
    """As after a stop in a turn: steering cuts the throttle, and the mkz's stayed below the dead band for good."""
    world = simulation if car == cars.DEFAULT else Simulation(simulation.town, car=cars.load(car))
    route, _ = approach(world)
    x, y = route.points[5]
    world.place(x=float(x), y=float(y), yaw=float(route.yaw[5]) + 0.7, seed=0)
    expert = expert_of(CollectConfig(), world)
    episode = rollout(world, expert, FollowRoute(route), num_steps=60, seed=0)
    assert np.abs(episode.labels[:10, 1]).min() > 0.9  # full lock
    assert episode.vehicle[-1, 3] > 1.0
    assert episode.infractions == ()


def test_free_drive_through_town03_is_clean_on_its_roundabout_too() -> None:
    town = library.load("town03")
    episode = drive_expert(Simulation(town), num_steps=700, seed=1)
    assert episode.infractions == ()
    ring = [lane.centerline for lane in town.lanes.values() if lane.id.startswith("600")]
    gaps = np.hypot(*(np.concatenate(ring)[:, None] - episode.vehicle[None, :, :2]).T)
    assert gaps.min() < 0.5, "expected the drive to lead round the ring"
