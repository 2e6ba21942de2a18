import dataclasses

import numpy as np
import pytest

from mjdrive.datatypes import Action, Episode, Observation
from mjdrive.episodes import driving
from mjdrive.errors import DataError
from mjdrive.recording.playback import Playback, car_of, town_of


class Witness:
    """Drives in a bend and remembers what it saw."""

    name = "witness"

    def reset(self, seed: int) -> None:
        self.seen: list[Observation] = []

    def act(self, view: Observation) -> Action:
        self.seen.append(view)
        return Action(1.5, 0.1 * len(self.seen))  # clipped when driven


def with_metadata(episode: Episode, **entries: str) -> Episode:
    return dataclasses.replace(episode, metadata={**episode.metadata, **entries})


def test_what_the_policy_saw_is_seen_again_bit_by_bit(playback: Playback) -> None:
    witness = Witness()
    episode = driving.drive(playback.simulation, witness, num_steps=8, seed=1)
    again = Playback(episode)
    for step in (7, 0, 3):  # in any order
        again.show(step)
        seen, meant = again.observe(), witness.seen[step]
        np.testing.assert_array_equal(seen.bev, meant.bev)
        np.testing.assert_array_equal(seen.state, meant.state)


def test_a_town_that_has_changed_is_refused(short_drive: Episode) -> None:
    assert town_of(short_drive).name == "town02"
    with pytest.raises(DataError, match="another map"):
        town_of(with_metadata(short_drive, town_digest="0" * 64))


def test_another_car_is_refused_and_one_of_the_users_own_is_asked_for(short_drive: Episode) -> None:
    assert car_of(short_drive).name == "default"
    with pytest.raises(DataError, match=r"'mkz' .*, another one"):
        car_of(short_drive, name="mkz")
    with pytest.raises(DataError, match="give its file with --car"):
        car_of(with_metadata(short_drive, car="mine.xml"))


def test_states_of_another_physics_are_refused_before_they_are_restored(
    short_drive: Episode,
) -> None:
    odd = dataclasses.replace(short_drive, physics=short_drive.physics[:, :-1])
    with pytest.raises(DataError, match=f"has {odd.physics.shape[1]} numbers of physics"):
        Playback(odd)
