import numpy as np
import pytest

from mjdrive import geometry
from mjdrive.config import DisturbanceConfig
from mjdrive.datatypes import Action, Episode, Observation
from mjdrive.episodes.disturbance import Disturbance
from mjdrive.episodes.driving import drive, drive_expert
from mjdrive.episodes.rollout import rollout
from mjdrive.episodes.views import FollowRoute, observe
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import routing


class Steady:
    """Holds one action and notes how many observations it was given."""

    name = "steady"

    def __init__(self) -> None:
        self.seen: list[Observation] = []

    def reset(self, seed: int) -> None:
        self.seed = seed
        self.seen = []

    def act(self, view: Observation) -> Action:
        self.seen.append(view)
        return Action(acceleration=0.5, steering=0.0)


def started(simulation: Simulation) -> Simulation:
    lane, station = routing.random_start(simulation.town, np.random.default_rng(1))
    simulation.reset(lane=lane, station=station, seed=1)
    return simulation


def test_rows_are_what_was_true_when_the_action_was_chosen(simulation: Simulation) -> None:
    policy = Steady()
    episode = rollout(started(simulation), policy, observe, num_steps=8, seed=5)
    assert (policy.seed, episode.seed, episode.policy) == (5, 5, "steady")
    np.testing.assert_allclose(episode.time, 0.1 * np.arange(8))
    np.testing.assert_allclose([seen.state[0] for seen in policy.seen], episode.vehicle[:, 3], 1e-5)
    np.testing.assert_array_equal(episode.actions, np.tile([0.5, 0.0], (8, 1)))


def test_stored_physics_brings_the_simulation_back(simulation: Simulation) -> None:
    episode = rollout(started(simulation), Steady(), observe, num_steps=8, seed=0)
    simulation.car.restore(episode.physics[3])
    vehicle = simulation.vehicle
    assert (vehicle.x, vehicle.y, vehicle.yaw) == tuple(episode.vehicle[3, :3])


def test_disturbance_changes_what_is_driven_and_not_the_label(simulation: Simulation) -> None:
    config = DisturbanceConfig(steering_rate_per_min=600.0)
    disturbance = Disturbance(config, np.random.default_rng(0))
    episode = rollout(
        started(simulation), Steady(), observe, num_steps=20, seed=0, disturbance=disturbance
    )
    assert np.all(episode.labels == [0.5, 0.0])
    assert np.ptp(episode.actions[:, 1]) > 0.1


def test_stop_ends_the_drive_after_the_step_that_asks_for_it(simulation: Simulation) -> None:
    told: list[int] = []
    episode = rollout(
        started(simulation),
        Steady(),
        observe,
        num_steps=50,
        seed=0,
        stop=lambda: len(told) == 4,
        on_step=told.append,
    )
    assert told == [1, 2, 3, 4]
    assert len(episode.time) == 4


def test_expert_and_learner_start_at_the_same_place(simulation: Simulation) -> None:
    first = drive(simulation, Steady(), num_steps=1, seed=11)
    second = drive_expert(simulation, num_steps=1, seed=11)
    np.testing.assert_array_equal(first.vehicle[0], second.vehicle[0])
    assert first.light_phase == second.light_phase


def test_same_seed_drives_alike(simulation: Simulation) -> None:
    drives: list[Episode] = [drive_expert(simulation, num_steps=60, seed=2) for _ in range(2)]
    np.testing.assert_array_equal(drives[0].physics, drives[1].physics)
    assert drives[0].infractions == drives[1].infractions


def test_another_walk_turns_another_way_from_the_same_start(simulation: Simulation) -> None:
    first, second = (drive_expert(simulation, num_steps=500, seed=2, walk=it) for it in (0, 1))
    np.testing.assert_array_equal(first.vehicle[:20], second.vehicle[:20])
    assert first.light_phase == second.light_phase
    assert np.hypot(*(first.vehicle[-1] - second.vehicle[-1])[:2]) > 5.0


def test_view_follows_a_route_that_crosses_itself(simulation: Simulation) -> None:
    lane, station = routing.random_start(simulation.town, np.random.default_rng(1))
    route = routing.random_route(
        simulation.town, lane=lane, station=station, length=60.0, rng=np.random.default_rng(0)
    )
    follow = FollowRoute(route)
    for target in range(0, 55, 5):
        x, y = route.points[target] + 0.5 * np.array(
            [-np.sin(route.yaw[target]), np.cos(route.yaw[target])]
        )
        simulation.place(x=float(x), y=float(y), yaw=float(route.yaw[target]), seed=0)
        situation = follow(simulation)
        assert situation.station == pytest.approx(float(route.station[target]), abs=0.3)
        assert situation.offset == pytest.approx(0.5, abs=0.1)
    assert not follow.is_finished
    assert geometry.stations(route.points)[-1] == pytest.approx(60.0, abs=0.1)
