import numpy as np
import pytest
import torch

from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Episode, Town
from mjdrive.errors import DataError
from mjdrive.learning import batches
from mjdrive.learning.batches import (
    LiveDemonstrations,
    PackedDemonstrations,
    demonstrations_of,
    states,
)
from mjdrive.town import routing

LENGTH = 6


@pytest.fixture(scope="module")
def episode(town02: Town) -> Episode:
    """A car that is carried along a street, with labels that differ from what was driven."""
    lane, _ = routing.random_start(town02, np.random.default_rng(0))
    point = town02.lanes[lane].centerline[0]
    vehicle = np.zeros((LENGTH, 6))
    vehicle[:, :2] = point + np.arange(LENGTH)[:, None]
    vehicle[:, 3] = np.arange(LENGTH)
    actions = np.stack([np.linspace(-1, 1, LENGTH), np.linspace(1, -1, LENGTH)], axis=1)
    return Episode(
        town="town02",
        policy="carried",
        seed=0,
        light_phase=9.5,
        time=0.1 * np.arange(LENGTH),
        physics=np.zeros((LENGTH, 1)),
        vehicle=vehicle,
        actions=actions,
        labels=0.5 * actions,
        on_lane=np.ones(LENGTH, bool),
        infractions=(),
        metadata={},
    )


def test_previous_action_is_the_one_driven_a_step_earlier(episode: Episode) -> None:
    seen = states(episode)
    np.testing.assert_array_equal(seen[0], [0.0, 0.0, 0.0])
    np.testing.assert_allclose(seen[1:, 1:], episode.actions[:-1], rtol=1e-6)
    np.testing.assert_allclose(seen[:, 0], episode.vehicle[:, 3])


def test_what_is_learnt_is_the_clean_label(episode: Episode, town02: Town) -> None:
    demonstrations = PackedDemonstrations([episode, episode], town02)
    assert len(demonstrations) == 2 * LENGTH
    np.testing.assert_allclose(demonstrations.actions[:LENGTH], episode.labels, rtol=1e-6)


def test_a_process_that_gets_no_pair_of_a_minibatch_gets_an_empty_batch(
    episode: Episode, town02: Town
) -> None:
    batch = PackedDemonstrations([episode], town02).batch(torch.arange(0))
    assert [tensor.shape for tensor in batch] == [(0, 5, 192, 192), (0, 3), (0, 2)]


def test_batches_hold_the_views_of_the_projector_bit_by_bit(episode: Episode, town02: Town) -> None:
    demonstrations = PackedDemonstrations([episode], town02)
    projector = BevProjector(town02)
    batch = demonstrations.batch(torch.tensor([4, 1]))
    for row, step in enumerate((4, 1)):
        x, y, yaw = episode.vehicle[step, :3]
        expected = projector.project(
            x=float(x), y=float(y), yaw=float(yaw), time=float(episode.time[step]), light_phase=9.5
        )
        np.testing.assert_array_equal(batch.bev[row], expected)
    np.testing.assert_allclose(batch.actions, episode.labels[[4, 1]], rtol=1e-6)


def test_views_drawn_when_they_are_needed_are_those_that_lie_in_memory(
    episode: Episode, town02: Town
) -> None:
    indices = torch.tensor([7, 0, 7, 3])
    kept = PackedDemonstrations([episode, episode], town02).batch(indices)
    live = LiveDemonstrations([episode, episode], town02).batch(indices)
    for ours, theirs in zip(live, kept, strict=True):
        assert torch.equal(ours, theirs)
        assert ours.stride() == theirs.stride()


def test_views_lie_in_memory_unless_they_are_too_many(
    episode: Episode, town02: Town, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert isinstance(demonstrations_of([episode], town02), PackedDemonstrations)
    assert isinstance(demonstrations_of([episode], town02, views="live"), LiveDemonstrations)
    monkeypatch.setattr(batches, "MOST_IN_MEMORY", LENGTH * 192 * 192 - 1)
    assert isinstance(demonstrations_of([episode], town02), LiveDemonstrations)
    assert isinstance(demonstrations_of([episode], town02, views="memory"), PackedDemonstrations)


def test_progress_counts_every_view(episode: Episode, town02: Town) -> None:
    told: list[int] = []
    PackedDemonstrations([episode], town02, on_frame=told.append)
    assert told == list(range(1, LENGTH + 1))


def test_episodes_of_another_town_and_no_episodes_are_refused(
    episode: Episode, town01: Town
) -> None:
    with pytest.raises(DataError, match="episodes of town02; expected demonstrations in town01"):
        PackedDemonstrations([episode], town01)
    with pytest.raises(DataError, match="no episode"):
        PackedDemonstrations([], town01)
