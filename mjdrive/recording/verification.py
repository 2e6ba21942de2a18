"""Whether the actions of an episode, driven again, lead through the same states bit by bit."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mjdrive import versions
from mjdrive.datatypes import Action, Episode
from mjdrive.recording.playback import Playback

DECIDING = ("mjdrive", "mujoco", "numpy")
"""Packages whose versions decide the states of a drive."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What came of driving an episode again.

    Attributes:
        steps: States that were compared [-].
        first_difference: Step whose state was the first to differ [-]; None if all are the same.
        farthest: Greatest distance between the car then and now [m].
        differing: Versions that are others here, as "mujoco 3.16.0, here 3.17.0"; "unknown" where the episode names none.
    """

    steps: int
    first_difference: int | None
    farthest: float
    differing: tuple[str, ...]

    @property
    def is_same(self) -> bool:
        """Whether every state was the same bit by bit."""
        return self.first_difference is None

    @property
    def words(self) -> str:
        """The verdict for people."""
        others = f"driven with {'; '.join(self.differing)}"
        if self.is_same:
            same = f"the same bit by bit at all {self.steps:,} steps"
            return f"{same}, though {others}" if self.differing else same
        found = f"differ from step {self.first_difference:,} on, by up to {self.farthest:.3g} m"
        if self.differing:
            return f"{found}: {others}"
        return f"{found}, though versions agree: the code of mjdrive, or the processor, is another"


def verify(playback: Playback, *, on_step: Callable[[int], None] = lambda done: None) -> Verdict:
    """Drive the actions of an episode again from its first state.

    Args:
        playback: The episode and its world.
        on_step: Told the number of states compared.

    Raises:
        PhysicsError: If the physics becomes unstable.
    """
    episode, simulation = playback.episode, playback.simulation
    playback.show(0)
    first: int | None = None
    farthest = 0.0
    for step, (acceleration, steering) in enumerate(episode.actions.tolist()):
        now = simulation.car.save()
        if first is None and now.tobytes() != episode.physics[step].tobytes():
            first = step
        vehicle = simulation.vehicle
        x, y = episode.vehicle[step, :2].tolist()
        farthest = max(farthest, float(np.hypot(vehicle.x - x, vehicle.y - y)))
        on_step(step + 1)
        if step + 1 < len(episode.time):  # nobody recorded what the last action led to
            simulation.step(Action(acceleration, steering))
    return Verdict(len(episode.time), first, farthest, differing_versions(episode))


def differing_versions(episode: Episode) -> tuple[str, ...]:
    """Say which versions that decide states are others here than when an episode was driven."""
    driven, here = versions.from_metadata(episode.metadata), versions.versions()
    return tuple(
        f"{name} {driven.get(name, 'unknown')}, here {here[name]}"
        for name in DECIDING
        if driven.get(name) != here[name]
    )
