"""Lights met on a crossing with one stop line at x = 40 m, green for 10 s, yellow for 3 s, then red for 32 s."""

from collections.abc import Callable

import numpy as np

from mjdrive.datatypes import Episode, Town
from mjdrive.evaluation.lights_met import LightsMet, lights_met

Make = Callable[..., Episode]


def test_who_goes_through_at_green_has_met_one_light(crossing: Town, make_drive: Make) -> None:
    assert lights_met(make_drive(np.linspace(0, 80, 60)), crossing) == LightsMet(1, 0)


def test_who_waits_at_red_has_met_one_red_light_however_long(
    crossing: Town, make_drive: Make
) -> None:
    x = np.concatenate([np.linspace(0, 36, 20), np.full(200, 36.0)])
    assert lights_met(make_drive(x, light_phase=14.0), crossing) == LightsMet(1, 1)


def test_each_time_counts_anew(crossing: Town, make_drive: Make) -> None:
    once = np.linspace(0, 80, 60)
    assert lights_met(make_drive(np.tile(once, 3)), crossing).lights == 3


def test_the_other_direction_the_other_lane_and_far_away_do_not_count(
    crossing: Town, make_drive: Make
) -> None:
    x = np.linspace(0, 80, 60)
    assert lights_met(make_drive(x[::-1], yaw=np.pi), crossing).lights == 0
    assert lights_met(make_drive(x, y=4.0), crossing).lights == 0
    assert lights_met(make_drive(x[x < 28]), crossing).lights == 0
