import dataclasses

import numpy as np

from mjdrive import versions
from mjdrive.datatypes import Episode
from mjdrive.recording.playback import Playback
from mjdrive.recording.verification import Verdict, differing_versions, verify


def judged(playback: Playback, episode: Episode) -> Verdict:
    before, playback.episode = playback.episode, episode
    try:
        return verify(playback)
    finally:
        playback.episode = before


def test_the_actions_of_a_drive_lead_to_its_states_bit_by_bit(
    playback: Playback, short_drive: Episode
) -> None:
    verdict = judged(playback, short_drive)
    assert verdict == Verdict(len(short_drive.time), None, 0.0, ())
    assert verdict.words == "the same bit by bit at all 15 steps"


def test_one_other_action_is_found_at_the_step_after_it(
    playback: Playback, short_drive: Episode
) -> None:
    actions = short_drive.actions.copy()
    actions[6, 1] += 1e-6
    verdict = judged(playback, dataclasses.replace(short_drive, actions=actions))
    assert (verdict.first_difference, verdict.is_same) == (7, False)
    assert 0.0 < verdict.farthest < 1e-3
    assert "though versions agree" in verdict.words


def test_other_versions_are_named(playback: Playback, short_drive: Episode) -> None:
    metadata = {**short_drive.metadata, "version.mujoco": "3.0.0"}
    physics = short_drive.physics + np.eye(1, short_drive.physics.shape[1], 5) * 1e-9
    older = dataclasses.replace(short_drive, metadata=metadata, physics=physics)
    verdict = judged(playback, older)
    here = versions.versions()["mujoco"]
    assert verdict.differing == (f"mujoco 3.0.0, here {here}",)
    assert f"driven with mujoco 3.0.0, here {here}" in verdict.words
    nothing_known = dataclasses.replace(short_drive, metadata={})
    assert len(differing_versions(nothing_known)) == 3
