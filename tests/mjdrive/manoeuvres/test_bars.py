import math

import pytest

from mjdrive.manoeuvres.bars import Bar, around, failed


@pytest.mark.parametrize(
    ("measured", "holds"), [(0.9, False), (1.0, True), (1.5, True), (2.0, True), (2.1, False)]
)
def test_limits_belong_to_the_bar(measured, holds):
    assert Bar("drive", "length", measured, "m", least=1.0, most=2.0).holds is holds


@pytest.mark.parametrize("measured", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_never_holds(measured):
    assert not Bar("drive", "length", measured, "m").holds


def test_one_limit_is_enough():
    assert Bar("drive", "length", -1e9, "m", most=0.0).holds
    assert Bar("drive", "length", 1e9, "m", least=0.0).holds


def test_limits_around_a_negative_value_are_in_order():
    assert around(-2.0, 0.1) == pytest.approx({"least": -2.2, "most": -1.8})


def test_failed_keeps_those_that_do_not_hold():
    good, bad = Bar("a", "b", 1.0, "m", most=2.0), Bar("a", "c", 3.0, "m", most=2.0)
    assert failed([good, bad]) == (bad,)
