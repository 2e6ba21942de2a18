import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.evaluation.bootstrap import interval, mean, rate, ratio_interval, total


@pytest.mark.parametrize(("num_seeds", "least"), [(3, 0.68), (5, 0.78), (20, 0.9)])
def test_interval_covers_the_truth_where_seeds_differ(num_seeds: int, least: float) -> None:
    rng = np.random.default_rng(0)
    hits = 0
    for _ in range(300):
        learnt = rng.normal(5.0, 1.0, size=(num_seeds, 1))
        found = interval(
            learnt + rng.normal(0.0, 0.5, size=(num_seeds, 20)), rng=rng, num_draws=300
        )
        hits += found.low <= 5.0 <= found.high
    assert least < hits / 300 <= 0.99


def test_starts_that_all_seeds_share_are_drawn_for_all_of_them() -> None:
    rng = np.random.default_rng(1)
    hits = 0
    for _ in range(200):
        starts = rng.normal(5.0, 1.0, size=(1, 10))
        found = interval(np.repeat(starts, 5, axis=0), rng=rng, num_draws=300)
        hits += found.low <= 5.0 <= found.high
    assert 0.85 < hits / 200 <= 0.99, "five seeds on ten starts are ten starts, not fifty"


def test_what_all_episodes_of_a_seed_share_counts_once() -> None:
    figures = np.repeat([[0.0], [10.0]], 50, axis=1)
    found = interval(figures, rng=np.random.default_rng(0))
    assert (found.value, found.low, found.high) == (5.0, 0.0, 10.0)


def test_single_seed_is_drawn_by_its_episodes() -> None:
    found = interval(np.array([[0.0, 50.0, 100.0]]), rng=np.random.default_rng(0))
    assert found.value == 50.0
    assert found.low < 20.0
    assert found.high > 80.0


def test_a_rate_is_a_sum_over_a_sum() -> None:
    above, below = np.array([[1.0, 0.0], [3.0, 0.0]]), np.array([[1.0, 1.0], [5.0, 1.0]])
    assert float(rate(above, below)) == 0.5
    assert np.isnan(rate(above, np.zeros((2, 2))))


def test_a_sum_over_episodes_is_the_mean_of_seeds() -> None:
    assert float(total(np.array([[1.0, 2.0], [3.0, 4.0]]))) == 5.0


def test_both_figures_of_a_rate_are_drawn_alike() -> None:
    below = np.random.default_rng(2).uniform(1.0, 9.0, size=(3, 10))
    found = interval(0.25 * below, below, rng=np.random.default_rng(0), statistic=rate)
    assert (found.value, found.low, found.high) == pytest.approx((0.25, 0.25, 0.25))


def test_what_happened_as_often_to_each_seed_is_a_matter_of_drives_yet() -> None:
    hits = np.zeros((3, 10))
    hits[[0, 1, 2], [0, 4, 7]] = 2.0
    found = interval(hits, rng=np.random.default_rng(0), statistic=total)
    assert found.value == 2.0
    assert found.low < 1.0
    assert found.high > 3.0


def test_rare_events_of_one_seed_are_drawn_by_its_drives() -> None:
    hits = np.array([[1.0] + [0.0] * 9])
    found = interval(hits, rng=np.random.default_rng(0), statistic=total, num_draws=20_000)
    draws = np.random.default_rng(3).binomial(10, 0.1, size=20_000)
    assert (found.low, found.high) == tuple(np.quantile(draws, [0.025, 0.975])) == (0.0, 3.0)


def test_draws_without_a_divisor_are_left_out() -> None:
    above, below = np.array([[1.0, 0.0, 0.0]]), np.array([[2.0, 0.0, 0.0]])
    found = interval(above, below, rng=np.random.default_rng(0), statistic=rate)
    assert (found.value, found.low, found.high) == (0.5, 0.5, 0.5)
    nothing = interval(above, 0 * below, rng=np.random.default_rng(0), statistic=rate)
    assert np.isnan([nothing.value, nothing.low, nothing.high]).all()


def test_interval_says_what_a_table_shows() -> None:
    found = interval(np.full((2, 2), 0.5), rng=np.random.default_rng(0))
    assert str(found) == "0.50 [0.50, 0.50]"
    assert str(interval(np.full((2, 2), 1234.0), rng=np.random.default_rng(0))) == (
        "1,234 [1,234, 1,234]"
    )


@given(st.integers(0, 2**32 - 1))
def test_same_seed_gives_the_same_interval(seed: int) -> None:
    figures = np.random.default_rng(seed).normal(size=(3, 5))
    first, second = (
        interval(figures, rng=np.random.default_rng(seed), num_draws=50) for _ in range(2)
    )
    assert first == second
    assert first.low <= first.high


def test_draws_of_a_batch_are_judged_one_by_one() -> None:
    batch = np.random.default_rng(0).normal(size=(4, 3, 5))
    for statistic in (mean, total):
        np.testing.assert_allclose(statistic(batch), [float(statistic(it)) for it in batch])
    assert float(mean(np.full((3, 5), 2.0))) == pytest.approx(2.0)
    assert float(total(np.full((3, 5), 2.0))) == pytest.approx(10.0)
    sizes = 1.0 + batch**2
    expected = [float(rate(a, b)) for a, b in zip(batch, sizes, strict=True)]
    np.testing.assert_allclose(rate(batch, sizes), expected)


def test_a_ratio_holds_the_chance_of_both_where_they_share_no_starts() -> None:
    rng = np.random.default_rng(5)
    figures, others = rng.normal(10.0, 1.0, size=(3, 10)), rng.normal(10.0, 1.0, size=(3, 12))
    found = ratio_interval(figures, others, rng=np.random.default_rng(0))
    number = np.full((1, 1), others.mean())
    against_a_number = ratio_interval(figures, number, rng=np.random.default_rng(0))
    assert found.value == pytest.approx(against_a_number.value)
    assert found.low < against_a_number.low < against_a_number.high < found.high


def test_a_ratio_does_not_count_what_makes_a_start_hard_for_both() -> None:
    starts = np.random.default_rng(5).normal(10.0, 3.0, size=(1, 10))
    found = ratio_interval(0.5 * np.repeat(starts, 3, axis=0), starts, rng=np.random.default_rng(0))
    assert (found.low, found.high) == pytest.approx((0.5, 0.5))


def test_a_ratio_has_no_unit() -> None:
    figures = np.random.default_rng(6).normal(10.0, 1.0, size=(2, 4))
    metres = ratio_interval(figures, figures + 1, rng=np.random.default_rng(0))
    feet = ratio_interval(3.28 * figures, 3.28 * (figures + 1), rng=np.random.default_rng(0))
    assert np.allclose((metres.value, metres.low, metres.high), (feet.value, feet.low, feet.high))
