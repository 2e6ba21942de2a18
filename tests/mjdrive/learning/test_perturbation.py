import copy
import dataclasses
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from mjdrive import geometry
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Action, Episode, Situation, Town
from mjdrive.episodes.collection import collect_route
from mjdrive.expert.pid import PidExpert
from mjdrive.learning import training
from mjdrive.learning.batches import EpisodeDemonstrations
from mjdrive.learning.perturbation import SLOWEST, perturb
from mjdrive.learning.settings import learner_settings
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library, routing
from models.config import PerturbationConfig
from models.errors import SettingError

MANIFEST = SimpleNamespace(town="town02", episodes=[SimpleNamespace(steps=50)], collections=[])

ALL = PerturbationConfig(share=1.0)


class Watched:
    """The PID expert, with all that it was shown."""

    name = "watched"

    def __init__(self, town: Town) -> None:
        self._expert = PidExpert(town)
        self.views: list[Situation] = []

    def reset(self, seed: int) -> None:
        self._expert.reset(seed)

    def act(self, view: Situation) -> Action:
        self.views.append(view)
        return self._expert.act(view)


@pytest.fixture(scope="module")
def drive(town02: Town, simulation: Simulation) -> tuple[Episode, list[Situation]]:
    """A minute with turns and lights, undisturbed, and what the expert was shown."""
    route = routing.route_through(
        town02, np.array(library.load_settings("town02").routes["route0"])
    )
    watched = Watched(town02)
    config = CollectConfig(disturbance=None)
    return collect_route(simulation, route, config=config, seed=0, expert=watched), watched.views


def straight(speed: float = 6.0, steps: int = 50) -> Episode:
    """A car that drives along y = 0 and steers a little."""
    vehicle = np.zeros((steps, 6))
    vehicle[:, 0], vehicle[:, 3] = 0.1 * speed * np.arange(steps), speed
    labels = np.full((steps, 2), 0.1)
    return Episode(
        town="town02", policy="carried", seed=0, light_phase=0.0, time=0.1 * np.arange(steps),
        physics=np.zeros((steps, 1)), vehicle=vehicle, actions=labels, labels=labels,
        on_lane=np.ones(steps, bool), infractions=(), metadata={},
    )  # fmt: skip


def moved(before: Episode, after: Episode) -> np.ndarray:
    return (before.vehicle[:, :3] != after.vehicle[:, :3]).any(axis=1)


def from_beside(view: Situation, pose: np.ndarray) -> Situation:
    """What the expert is shown if it stands elsewhere."""
    x, y, yaw = map(float, pose)
    near = int(np.searchsorted(view.route.station, view.station))
    place = geometry.project(
        view.route.points,
        np.array([x, y]),
        first_segment=max(near - 15, 0),
        last_segment=near + 15,
    )
    return dataclasses.replace(
        view,
        vehicle=dataclasses.replace(view.vehicle, x=x, y=y, yaw=yaw),
        station=float(view.route.station[0]) + place.station,
        offset=place.offset,
    )


def test_the_label_is_what_the_expert_would_do_there(
    drive: tuple[Episode, list[Situation]], town02: Town
) -> None:
    episode, views = drive
    after = perturb(episode, ALL, np.random.default_rng(0))
    expert = PidExpert(town02)
    errors, changes, accelerations = [], [], []
    for step, view in enumerate(views):
        if moved(episode, after)[step] and step % 7 == 0:
            there = copy.deepcopy(expert).act(from_beside(view, after.vehicle[step, :3]))
            errors.append(after.labels[step, 1] - there.steering)
            changes.append(after.labels[step, 1] - episode.labels[step, 1])
            accelerations.append(after.labels[step, 0] - there.acceleration)
        assert expert.act(view).steering == episode.labels[step, 1]
    assert len(errors) > 50
    assert np.median(np.abs(changes)) > 0.15
    assert np.max(np.abs(errors)) < 0.03
    assert np.median(np.abs(accelerations)) < 0.02


def test_who_is_seen_left_of_its_way_steers_right_and_who_is_turned_left_too() -> None:
    episode, bounds = straight(), PerturbationConfig(share=1.0, offset=0.5, heading=0.0)
    after = perturb(episode, bounds, np.random.default_rng(0))
    offset = after.vehicle[:, 1]
    np.testing.assert_allclose(after.labels[:, 1], 0.1 - 2.2 * np.arctan(offset / 5.0))
    turned = perturb(
        episode, dataclasses.replace(bounds, offset=0.0, heading=0.3), np.random.default_rng(0)
    )
    np.testing.assert_allclose(turned.labels[:, 1], 0.1 - 2.2 * turned.vehicle[:, 2])
    assert np.abs(offset).max() == pytest.approx(0.5, rel=0.1)
    assert np.abs(turned.vehicle[:, 2]).max() == pytest.approx(0.3, rel=0.1)


def test_only_pose_and_steering_change_and_commands_keep_their_range() -> None:
    episode, far = straight(), PerturbationConfig(share=1.0, offset=3.0, heading=0.8)
    after = perturb(episode, far, np.random.default_rng(0))
    np.testing.assert_array_equal(after.vehicle[:, 3:], episode.vehicle[:, 3:])
    np.testing.assert_array_equal(after.labels[:, 0], episode.labels[:, 0])
    np.testing.assert_array_equal(after.actions, episode.actions)
    assert np.abs(after.labels).max() == 1.0


def test_a_car_that_hardly_moves_is_seen_where_it_stood() -> None:
    slow = straight(speed=0.9 * SLOWEST)
    assert not moved(slow, perturb(slow, ALL, np.random.default_rng(0))).any()


@pytest.mark.parametrize("share", [0.0, 0.25, 1.0])
def test_so_many_moments_are_seen_from_beside(share: float) -> None:
    episode = straight(steps=4000)
    config = PerturbationConfig(share=share)
    after = perturb(episode, config, np.random.default_rng(0))
    assert moved(episode, after).mean() == pytest.approx(share, abs=0.03)
    again = perturb(episode, config, np.random.default_rng(0))
    np.testing.assert_array_equal(after.vehicle, again.vehicle)
    assert (
        share == 0
        or (perturb(episode, config, np.random.default_rng(1)).vehicle != after.vehicle).any()
    )


def test_training_learns_from_the_perturbed_pairs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, town02: Town
) -> None:
    """And of each seed from others."""
    seen: list[EpisodeDemonstrations] = []

    def fit(
        learner: object, pairs: EpisodeDemonstrations, *_: object, **__: object
    ) -> list[object]:
        seen.append(pairs)
        return []

    monkeypatch.setattr(training, "fit", fit)
    there = straight()
    street = next(iter(town02.lanes.values())).centerline[0]
    there = dataclasses.replace(there, vehicle=there.vehicle + np.array([*street, 0, 0, 0, 0]))
    monkeypatch.setattr(training.dataset, "read_dataset", lambda _: (MANIFEST, [there]))
    monkeypatch.setattr(training.dataset, "digest", lambda _: "0" * 64)
    for seed, share in ((0, 0.0), (0, 1.0), (0, 1.0), (1, 1.0)):
        config = learner_settings(
            "bc-beta", preset="quick", assignments=[f"perturbation.share={share}"]
        )
        training.train(config, data=tmp_path, run=tmp_path / "run", seed=seed, device="cpu")
    plain, *others = [it.actions.numpy() for it in seen]
    np.testing.assert_allclose(plain, straight().labels, rtol=1e-6)
    expected = perturb(straight(), ALL, np.random.default_rng([0, 1]))
    np.testing.assert_allclose(others[0], expected.labels, rtol=1e-6)
    np.testing.assert_array_equal(others[0], others[1])
    assert (others[1] != others[2]).any()
    views = [it.batch(torch.tensor([20])).bev for it in seen]
    assert not torch.equal(views[0], views[1])


@pytest.mark.parametrize("given", [{"share": 1.5}, {"offset": -0.1}, {"heading": 1.6}])
def test_settings_without_a_meaning_are_refused(given: dict[str, float]) -> None:
    with pytest.raises(SettingError, match=next(iter(given))):
        PerturbationConfig(**given)
