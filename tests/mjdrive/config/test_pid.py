import dataclasses
import math

import pytest

from mjdrive.config import PidConfig, from_dict
from mjdrive.errors import ConfigError

NUMBERS = [field.name for field in dataclasses.fields(PidConfig) if type(field.default) is float]


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, -1.0])
def test_number_without_a_meaning_is_refused_by_name(name: str, value: float):
    default = getattr(PidConfig(), name)
    with pytest.raises(ConfigError, match=rf"{name} is {value}; expected .*default {default}\."):
        PidConfig(**{name: value})


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("throttle_cut", 7.0),
        ("braking", 0.0),
        ("target_distance", 0.0),
        ("integral_window", 0),
        ("speed_gains", (0.5, math.nan, 0.1)),
        ("steering_gains", (2.2, 0.05, -0.1)),
        ("steering_gains", (math.inf, 0.05, 0.0)),
    ],
)
def test_setting_outside_its_range_is_refused_with_its_default(name: str, value: object):
    with pytest.raises(ConfigError, match=rf"{name} is .*; expected .*, such as the default"):
        PidConfig(**{name: value})


@pytest.mark.parametrize("gains", [(), (2.2,), (2.2, 0.05, 0.0, 0.0)])
def test_other_numbers_of_gains_than_three_are_refused(gains: tuple[float, ...]):
    found = r"(Not enough|Too many) values .* tuple\[float, float, float\]\) @ PidConfig\.steering_gains"
    with pytest.raises(ConfigError, match=found):
        from_dict(PidConfig, {"steering_gains": list(gains)})


def test_gain_that_steers_nowhere_is_refused():
    with pytest.raises(ConfigError, match="expected P, the first, to be more than 0"):
        PidConfig(steering_gains=(0.0, 0.05, 0.0))


def test_turns_are_no_faster_than_streets():
    with pytest.raises(ConfigError, match=r"turn_speed is 9\.0 m/s; expected at most target_speed"):
        PidConfig(turn_speed=9.0)


@pytest.mark.parametrize(
    ("name", "value"), [("throttle_cut", 0.0), ("stop_gap", 0.0), ("recovery_offset", 0.0)]
)
def test_edge_of_a_range_is_a_setting(name: str, value: float):
    assert getattr(PidConfig(**{name: value}), name) == value
