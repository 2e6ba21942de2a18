import pytest

from mjdrive.benchmarks.comparison import Comparison, Figure, NotMeasured, Reads
from mjdrive.benchmarks.wording import amount, line, number


def test_comparison_says_both_times_a_piece_the_ratio_and_its_spread() -> None:
    row = Comparison(
        "row", "work", "us", "them", (1.0, 1.0), (3.0, 5.0), bar=2.0, pieces=1000.0, piece="step"
    )
    shown = line(row)
    assert shown.ours == "us: 1 ms a step"
    assert shown.theirs == "them: 4 ms a step"
    assert shown.result == "4x faster (3.5 to 4.5)"
    assert shown.bar == "at least 2x"
    assert shown.holds is True


def test_cost_reads_the_other_way_round() -> None:
    row = Comparison("row", "work", "us", "them", (3.0,), (2.0,), bar=1.4, reads=Reads.COST)
    shown = line(row)
    assert (shown.result, shown.bar, shown.holds) == (
        "1.5x as long (1.5 to 1.5)",
        "at most 1.4x",
        False,
    )


def test_figure_without_limits_is_not_judged() -> None:
    assert line(Figure("row", "work", (2.0,), "MB")).holds is None
    assert line(Figure("row", "work", (2.0,), "MB", most=1.0)).holds is False


def test_row_that_is_missing_says_why_and_what_to_do() -> None:
    shown = line(NotMeasured("row", "work", "It is not here.", "make it"))
    assert shown.result == "not measured"
    assert shown.note == "It is not here. Makes it possible: make it"


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(2.0, "2 s"), (0.0123, "12.3 ms"), (117e-6, "117 us"), (0.0, "0 us"), (2100.0, "2,100 s")],
)
def test_times_have_the_unit_that_suits_them(seconds: float, words: str) -> None:
    assert amount(seconds, "s") == words


@pytest.mark.parametrize(
    ("value", "words"), [(1234.5, "1,234"), (0.118, "0.118"), (9e-5, "9.0e-05")]
)
def test_numbers_keep_three_digits(value: float, words: str) -> None:
    assert number(value) == words
