import numpy as np
import pytest

from mjdrive.evaluation.comfort import jerk_rms, steering_unrest, steering_whiteness

INTERVAL = 0.1
TIME = INTERVAL * np.arange(2001)


def test_even_acceleration_has_no_jerk_and_an_even_turn_of_the_wheel_no_unrest():
    ramp = 3.0 + 0.5 * TIME
    assert jerk_rms(ramp, interval=INTERVAL) == pytest.approx(0.0, abs=1e-9)
    assert steering_unrest(ramp, interval=INTERVAL) == pytest.approx(0.0, abs=1e-9)
    assert steering_whiteness(ramp, interval=INTERVAL) == pytest.approx(0.5)


def test_figures_of_a_sine_are_its_derivatives():
    amplitude, rate = 0.2, 0.5
    wave = amplitude * np.sin(rate * TIME)
    assert steering_whiteness(wave, interval=INTERVAL) == pytest.approx(
        amplitude * rate / np.sqrt(2), rel=0.01
    )
    second = amplitude * rate**2 / np.sqrt(2)
    assert steering_unrest(wave, interval=INTERVAL) == pytest.approx(second, rel=0.01)
    assert jerk_rms(wave, interval=INTERVAL) == pytest.approx(second, rel=0.01)


def test_unrest_tells_a_twitching_hand_from_a_steady_one_that_turns_as_far():
    steady = np.linspace(0.0, 1.0, 101)
    twitching = np.repeat(steady[::5], 5)[:101]
    assert steering_unrest(twitching, interval=INTERVAL) > 5 * steering_unrest(
        steady, interval=INTERVAL
    )


def test_drives_too_short_to_judge_count_as_smooth():
    assert jerk_rms(np.ones(2), interval=INTERVAL) == 0.0
    assert steering_whiteness(np.ones(1), interval=INTERVAL) == 0.0
    assert steering_unrest(np.ones(2), interval=INTERVAL) == 0.0
