"""The rightmost way, in a town whose lanes say themselves which way they lead."""

from mjdrive.datatypes import Move, Town
from mjdrive.evaluation.choices import approaches
from mjdrive.town.rightmost import rightmost


def test_right_goes_before_straight_and_straight_before_left(town02: Town) -> None:
    forks = approaches(town02)
    assert len(forks) > 10
    order = (Move.RIGHT, Move.STRAIGHT, Move.LEFT)
    for fork in forks:
        moves = {name: town02.lanes[name].move for name in fork.exits}
        taken = rightmost(town02, fork.exits)
        assert moves[taken] is min(moves.values(), key=order.index)


def test_a_single_way_is_taken(town02: Town) -> None:
    name = next(iter(town02.lanes))
    assert rightmost(town02, [name]) == name
