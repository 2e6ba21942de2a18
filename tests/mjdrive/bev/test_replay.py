import dataclasses

import numpy as np

from mjdrive.bev.layers import LIGHT_LAYERS
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Action, Observation, Town
from mjdrive.episodes import driving
from mjdrive.simulation.simulation import Simulation


class Watcher:
    """Drives ahead, and remembers what it saw."""

    name = "watcher"

    def __init__(self) -> None:
        self.seen: list[np.ndarray] = []

    def reset(self, seed: int) -> None:
        self.seen = []

    def act(self, view: Observation) -> Action:
        self.seen.append(view.bev.copy())
        return Action(acceleration=0.7, steering=0.0)


def test_an_episode_shows_again_what_its_policy_saw(town02: Town) -> None:
    watcher = Watcher()
    episode = driving.drive(Simulation(town02), watcher, num_steps=30, seed=11)
    projector = BevProjector(town02)
    assert len(watcher.seen) == 30
    assert not np.array_equal(watcher.seen[0], watcher.seen[-1])
    lights = list(LIGHT_LAYERS)
    assert any(seen[lights].any() for seen in watcher.seen)
    later = dataclasses.replace(episode, light_phase=episode.light_phase + 20.0)
    assert any(
        not np.array_equal(projector.replay(later, step), seen)
        for step, seen in enumerate(watcher.seen)
    )
    for step, seen in enumerate(watcher.seen):
        np.testing.assert_array_equal(projector.replay(episode, step), seen)
