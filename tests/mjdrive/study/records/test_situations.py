import dataclasses

import numpy as np
import pytest

from mjdrive.bev.layers import LIGHT_VALUES, Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Move, Signal, Town
from mjdrive.errors import RouteError
from mjdrive.study.records.situations import Moment, situations


@pytest.fixture(scope="module")
def moments(town02: Town) -> dict[str, Moment]:
    return {moment.name: moment for moment in situations(town02)}


def test_one_junction_is_looked_at_undecided_on_both_ways_and_at_red(
    moments: dict[str, Moment],
) -> None:
    assert list(moments) == ["fork", "left", "right", "red"]
    assert len({moment.approach for moment in moments.values()}) == 1


def test_the_car_turns_to_the_side_that_the_moment_is_named_after(
    moments: dict[str, Moment],
) -> None:
    yaw = {name: np.unwrap([moments["fork"].yaw, it.yaw])[1] for name, it in moments.items()}
    assert yaw["right"] < yaw["fork"] < yaw["left"]
    assert moments["right"].steering < 0 < moments["left"].steering


def test_the_car_moves_except_at_red(moments: dict[str, Moment]) -> None:
    assert [name for name, it in moments.items() if it.speed == 0.0] == ["red"]
    assert moments["red"].acceleration == -1.0


@pytest.mark.parametrize(("name", "signal"), [("fork", Signal.GREEN), ("red", Signal.RED)])
def test_the_light_ahead_shows_its_colour_through_all_of_the_history(
    moments: dict[str, Moment], town02: Town, name: str, signal: Signal
) -> None:
    projector = BevProjector(town02)
    bev = moments[name].observe(projector).bev
    config = projector.config
    middle = slice(config.size_px // 2 - 4, config.size_px // 2 + 4)
    row = config.size_px - config.ego_above_bottom_px
    ahead = bev[Layer.LIGHTS_OLDEST :, row - 40 : row + 20, middle]
    assert all(set(np.unique(layer)) == {0, LIGHT_VALUES[signal]} for layer in ahead)


def test_the_same_town_gives_the_same_moments(town02: Town, moments: dict[str, Moment]) -> None:
    assert situations(town02) == tuple(moments.values())


def test_a_town_without_a_choice_of_two_is_refused(town02: Town) -> None:
    lanes = {
        name: dataclasses.replace(lane, successors=lane.successors[:1])
        for name, lane in town02.lanes.items()
    }
    with pytest.raises(RouteError, match=r"no junction with two ways"):
        situations(dataclasses.replace(town02, lanes=lanes))


def test_left_and_right_are_preferred_to_straight_on(
    town02: Town, moments: dict[str, Moment]
) -> None:
    exits = town02.lanes[moments["fork"].approach].successors
    assert {town02.lanes[name].move for name in exits} == {Move.LEFT, Move.RIGHT}
