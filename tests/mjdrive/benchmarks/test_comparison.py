import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.benchmarks.comparison import Comparison, Figure, Plan, Reads, spread
from mjdrive.errors import ConfigError

SECONDS = st.floats(1e-3, 1e3)


def comparison(ours: tuple[float, ...], theirs: tuple[float, ...], **fields) -> Comparison:
    return Comparison("row", "work", "ours", "theirs", ours, theirs, **{"bar": 2.0, **fields})


def test_ratio_is_the_median_of_pairs_and_not_of_sides() -> None:
    row = comparison((1.0, 10.0, 1.0), (2.0, 30.0, 4.0))
    assert row.ratio == (2.5, 3.0, 3.5)  # of 2, 3 and 4


@given(st.lists(st.tuples(SECONDS, SECONDS), min_size=1, max_size=9))
def test_a_busy_machine_that_slows_both_sides_changes_no_ratio(pairs) -> None:
    ours, theirs = zip(*pairs, strict=True)
    slow = comparison(tuple(4 * it for it in ours), tuple(4 * it for it in theirs))
    assert slow.ratio == comparison(ours, theirs).ratio


def test_speed_has_to_reach_its_bar_and_cost_to_stay_below() -> None:
    assert comparison((1.0,), (2.0,)).holds
    assert not comparison((1.0,), (1.99,)).holds
    assert comparison((2.0,), (1.0,), reads=Reads.COST).holds
    assert not comparison((2.01,), (1.0,), reads=Reads.COST).holds


def test_times_are_shown_a_piece() -> None:
    row = comparison((2.0, 4.0, 6.0), (8.0, 8.0, 8.0), pieces=4.0)
    assert (row.our_piece, row.their_piece) == (1.0, 2.0)


@pytest.mark.parametrize(("ours", "theirs"), [((), ()), ((1.0,), (1.0, 2.0))])
def test_rounds_that_are_no_pairs_are_refused(ours, theirs) -> None:
    with pytest.raises(ConfigError, match="expected pairs, at least one"):
        comparison(ours, theirs)


@pytest.mark.parametrize(
    ("value", "limits", "holds"),
    [
        (1.0, {"most": 1.0}, True),
        (1.1, {"most": 1.0}, False),
        (0.9, {"least": 1.0}, False),
        (math.inf, {}, False),
        (math.nan, {"most": 1.0}, False),
    ],
)
def test_figure_holds_within_its_limits(value: float, limits: dict, holds: bool) -> None:
    assert Figure("row", "work", (value,), "s", **limits).holds is holds


@given(st.lists(SECONDS, min_size=1, max_size=20))
def test_quartiles_lie_around_the_median(values: list[float]) -> None:
    low, median, high = spread(values)
    assert min(values) <= low <= median <= high <= max(values)


def test_quick_plans_measure_two_rounds_at_most(tmp_path) -> None:
    assert Plan(tmp_path, quick=True).rounds(15) == 2
    assert Plan(tmp_path, quick=True).rounds(1) == 1
    assert Plan(tmp_path).rounds(15) == 15
