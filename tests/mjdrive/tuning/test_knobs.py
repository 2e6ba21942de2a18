import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.config import PidConfig
from mjdrive.errors import UnknownNameError
from mjdrive.tuning.knobs import KNOBS, default_settings, knobs, places_of, turned


@pytest.mark.parametrize("expert", KNOBS)
def test_settings_before_tuning_lie_within_the_limits_and_come_back(expert):
    settings = default_settings(expert)
    places = places_of(settings, knobs(expert))
    assert np.all((places > 0) & (places < 1))
    again = places_of(turned(settings, knobs(expert), places), knobs(expert))
    np.testing.assert_allclose(again, places, atol=1e-3)


@given(place=st.floats(0, 1))
def test_place_and_value_are_inverse(place):
    chosen = knobs("pid")
    places = np.full(len(chosen), place)
    np.testing.assert_allclose(
        places_of(turned(PidConfig(), chosen, places), chosen), places, atol=1e-3
    )


def test_places_beyond_the_limits_are_the_limits():
    chosen = knobs("pid")
    low, high = (turned(PidConfig(), chosen, np.full(len(chosen), end)) for end in (-3.0, 4.0))
    assert (low.steering_gains[0], high.steering_gains[0]) == (0.4, 5.0)
    assert (low.target_distance, high.target_distance) == (3.0, 10.0)


def test_settings_without_a_knob_stay():
    chosen = knobs("pid")
    changed = turned(PidConfig(), chosen, np.full(len(chosen), 0.5))
    assert changed.steering_gains[2] == PidConfig().steering_gains[2]
    assert changed.target_speed == PidConfig().target_speed


def test_unknown_expert_is_refused_by_name():
    with pytest.raises(UnknownNameError, match="pdi"):
        knobs("pdi")
