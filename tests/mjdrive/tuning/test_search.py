import numpy as np

from mjdrive.config import PidConfig, TuneConfig
from mjdrive.tuning.knobs import knobs, places_of
from mjdrive.tuning.marks import Marks
from mjdrive.tuning.search import best, search

CHOSEN = knobs("pid")
GOAL = np.full(len(CHOSEN), 0.6)


def bowl(settings: PidConfig) -> Marks:
    """Costs the squared distance of the knobs from a goal."""
    away = places_of(settings, CHOSEN) - GOAL
    return Marks(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0, float(away @ away))


def found(trials: int, seed: int = 0):
    return search(PidConfig(), CHOSEN, bowl, config=TuneConfig(trials=trials), seed=seed)


def test_search_finds_the_bottom_of_a_bowl():
    tried = found(400)
    assert best(tried).marks.cost < 1e-3 < tried[0].marks.cost


def test_start_is_the_first_trial_and_the_number_of_trials_is_kept():
    tried = found(23)
    assert len(tried) == 23
    assert tried[0].settings == PidConfig()


def test_same_seed_tries_the_same_and_another_seed_does_not():
    assert found(20) == found(20)
    assert found(20) != found(20, seed=1)


def test_best_of_equals_is_the_earliest():
    tried = found(5)
    assert best((tried[0], tried[0])) is tried[0]
