"""Trajectories drawn by hand: the car is pushed at 1 s and what follows is known."""

import numpy as np
import pytest

from mjdrive.datatypes import Episode, Infraction, InfractionKind
from mjdrive.episodes import recovery
from mjdrive.episodes.recovery import Recoveries, recoveries

INTERVAL = 0.1
STEPS = 300
PUSH = slice(10, 20)


def drive(*, pushes: tuple[slice, ...] = (PUSH,), breach: float | None = None) -> Episode:
    """30 s at 6 m/s; the steering is pushed where the slices say."""
    labels = np.zeros((STEPS, 2))
    actions = labels.copy()
    for push in pushes:
        actions[push, 1] = 0.4
    vehicle = np.zeros((STEPS, 6))
    vehicle[:, 3] = 6.0
    infractions = (
        () if breach is None else (Infraction(InfractionKind.KERB, breach, 0.0, 0.0, "kerb"),)
    )
    return Episode(
        town="t",
        policy="p",
        seed=0,
        light_phase=0.0,
        time=INTERVAL * np.arange(STEPS),
        physics=np.zeros((STEPS, 1)),
        vehicle=vehicle,
        actions=actions,
        labels=labels,
        on_lane=np.ones(STEPS, bool),
        infractions=infractions,
        metadata={},
    )


def bump(start: float, end: float, height: float = 1.0) -> np.ndarray:
    """A distance from the route that is `height` from one time to another."""
    time = INTERVAL * np.arange(STEPS)
    return np.where((time >= start - 1e-9) & (time < end - 1e-9), height, 0.0)


def count(episode: Episode, offset: np.ndarray, heading: np.ndarray | None = None) -> Recoveries:
    straight = np.zeros(STEPS) if heading is None else heading
    return recoveries(episode, offset=offset, heading_error=straight)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_car_that_comes_back_in_time_has_recovered(side: float) -> None:
    assert count(drive(), side * bump(1.5, 4.0)) == (1, 1)


def test_heading_alone_is_a_deviation() -> None:
    assert count(drive(), np.zeros(STEPS), bump(1.5, 3.0, -0.4)) == (1, 1)
    assert count(drive(), np.zeros(STEPS), bump(1.5, 3.0, 0.2)) == (0, 0)


def test_small_distance_is_no_deviation() -> None:
    assert count(drive(), bump(1.5, 4.0, recovery.OFF_OFFSET - 0.01)) == (0, 0)


def test_car_that_stays_away_for_too_long_has_not_recovered() -> None:
    last_push = 1.9
    late = last_push + recovery.TIME_TO_RECOVER
    assert count(drive(), bump(1.5, late - 1.0)) == (1, 1)
    assert count(drive(), bump(1.5, late + 1.0)) == (1, 0)


def test_half_way_back_is_not_back() -> None:
    between = 0.5 * (recovery.BACK_OFFSET + recovery.OFF_OFFSET)
    assert count(drive(), bump(1.5, 3.0) + bump(3.0, 20.0, between)) == (1, 0)


def test_passing_the_route_on_the_way_to_its_other_side_is_not_back() -> None:
    swing = bump(1.5, 3.0) - bump(3.3, 20.0)
    assert count(drive(), swing) == (1, 0)


def test_infraction_on_the_way_back_is_no_recovery() -> None:
    assert count(drive(breach=2.0), bump(1.5, 4.0)) == (1, 0)
    assert count(drive(breach=9.0), bump(1.5, 4.0)) == (1, 1)


def test_what_nobody_pushed_is_the_drivers_own_way() -> None:
    assert count(drive(pushes=()), bump(1.5, 4.0)) == (0, 0)
    assert count(drive(), bump(1.9 + recovery.PUSHED_WITHIN + 0.2, 8.0)) == (0, 0)


def test_time_at_a_light_does_not_count() -> None:
    episode = drive()
    vehicle = episode.vehicle.copy()
    vehicle[30:150, 3] = 0.0
    standing = Episode(
        **{name: getattr(episode, name) for name in episode.__slots__ if name != "vehicle"},
        vehicle=vehicle,
    )
    assert count(standing, bump(1.5, 16.0)) == (1, 1)


def test_two_pushes_are_two_deviations_and_one_while_away_is_none() -> None:
    twice = drive(pushes=(PUSH, slice(100, 110)))
    assert count(twice, bump(1.5, 4.0) + bump(10.5, 12.0)) == (2, 2)
    while_away = drive(pushes=(PUSH, slice(40, 50)))
    assert count(while_away, bump(1.5, 10.0)) == (1, 1)


def test_deviation_in_which_the_drive_ends_counts_neither_way() -> None:
    late = drive(pushes=(slice(280, 290),))
    assert count(late, bump(28.5, 30.0)) == (0, 0)


def test_lost_car_is_one_deviation_until_it_is_back() -> None:
    pushes = tuple(slice(start, start + 10) for start in (10, 110, 130))
    assert count(drive(pushes=pushes), bump(1.5, 14.5)) == (1, 0)


def test_clipping_a_command_is_no_push() -> None:
    episode = drive(pushes=())
    labels = episode.labels.copy()
    labels[:, 0], actions = 1.5, episode.actions.copy()
    actions[:, 0] = 1.0
    others = {name: getattr(episode, name) for name in episode.__slots__}
    clipped = Episode(**{**others, "labels": labels, "actions": actions})
    assert not recovery.is_pushed(clipped).any()
