import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.datatypes import Town
from mjdrive.evaluation.choices import (
    approaches,
    choice_statistics,
    entropy,
    jensen_shannon,
)
from mjdrive.town.random_lanes import random_lanes

SHARES = st.lists(st.floats(0.01, 1.0), min_size=3, max_size=3).map(
    lambda values: np.array(values) / sum(values)
)


def test_town02_asks_for_a_choice_at_every_approach(town02: Town) -> None:
    forks = approaches(town02)
    assert len(forks) == 24
    assert sum(len(fork.exits) for fork in forks) == 48
    assert all(sum(fork.shares) == pytest.approx(1.0) for fork in forks)


def test_random_walk_is_calibrated_and_covers_the_town(town02: Town) -> None:
    walk = random_lanes(
        town02,
        lane=approaches(town02)[0].lane,
        station=0.0,
        length=math.inf,
        rng=np.random.default_rng(0),
    )
    counts: dict[str, int] = {}
    for _ in range(6000):
        name = next(walk)
        if town02.lanes[name].junction is not None:
            counts[name] = counts.get(name, 0) + 1
    found = choice_statistics(counts, town02, rng=np.random.default_rng(1))
    assert (found.taken, found.recall, found.branches) == (48, 1.0, 48)
    assert found.passes == sum(counts.values())
    assert found.entropy == pytest.approx(1.0, abs=0.01)
    assert found.divergence is not None
    assert found.divergence_floor is not None
    assert found.divergence == pytest.approx(found.divergence_floor, rel=0.4)
    assert found.turn_divergence == pytest.approx(0.0, abs=1e-3)
    assert sum(found.turn_shares.values()) == pytest.approx(1.0)


def test_who_always_turns_the_same_way_has_no_entropy(town02: Town) -> None:
    counts = {fork.exits[0]: 30 for fork in approaches(town02)}
    found = choice_statistics(counts, town02, rng=np.random.default_rng(0))
    assert found.recall == 0.5
    assert found.entropy == 0.0
    # A half and a half against all and nothing.
    assert found.divergence == pytest.approx(0.311278, abs=1e-6)
    assert found.divergence_floor is not None
    assert found.divergence_floor < 0.02


def test_who_never_comes_to_a_junction_chooses_nothing(town02: Town) -> None:
    found = choice_statistics({}, town02, rng=np.random.default_rng(0))
    assert (found.taken, found.passes, found.recall) == (0, 0, 0.0)
    assert found.entropy is found.divergence is found.turn_divergence is None


def test_few_passes_say_nothing_of_the_entropy(town02: Town) -> None:
    counts = dict.fromkeys(approaches(town02)[0].exits, 9)
    assert choice_statistics(counts, town02, rng=np.random.default_rng(0)).entropy is None


def test_miller_and_madow_take_most_of_the_bias_away() -> None:
    rng = np.random.default_rng(0)
    truth = np.array([0.5, 0.3, 0.2])
    exact = -float(np.sum(truth * np.log(truth)))
    drawn = rng.multinomial(25, truth, size=4000)
    shares = drawn / 25
    plain = -np.sum(shares * np.log(np.where(shares > 0, shares, 1.0)), axis=1).mean()
    corrected = np.mean([entropy(counts) for counts in drawn])
    assert abs(corrected - exact) < 0.35 * abs(plain - exact)


@pytest.mark.parametrize(
    ("counts", "expected"), [([0, 0], 0.0), ([7, 0], 0.0), ([500, 500], math.log(2))]
)
def test_entropy_at_its_ends(counts: list[int], expected: float) -> None:
    assert entropy(np.array(counts)) == pytest.approx(expected)


@given(SHARES, SHARES)
def test_divergence_is_symmetric_and_between_zero_and_one(p: np.ndarray, q: np.ndarray) -> None:
    there, back = float(jensen_shannon(p, q)), float(jensen_shannon(q, p))
    assert there == pytest.approx(back, abs=1e-12)
    assert -1e-12 <= there <= 1.0
    assert float(jensen_shannon(p, p)) == pytest.approx(0.0, abs=1e-12)


def test_divergence_of_what_has_nothing_in_common_is_one() -> None:
    assert float(jensen_shannon(np.array([1.0, 0.0]), np.array([0.0, 1.0]))) == 1.0
