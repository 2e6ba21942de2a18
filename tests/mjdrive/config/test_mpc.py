import math

import pytest

from mjdrive.config import MpcConfig
from mjdrive.errors import ConfigError


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("horizon", 0.0),
        ("horizon", math.inf),
        ("horizon", 21.0),
        ("lane_margin", -0.1),
        ("max_braking", math.inf),
        ("max_jerk", math.nan),
        ("jerk_tolerance", math.inf),
        ("offset_tolerance", 0.0),
        ("final_heading_tolerance", -0.1),
        ("tolerance", 0.0),
        ("steering_rate_share", 1.5),
        ("max_braking", 1.0),
        ("max_iterations", 0),
        ("late_after", -1.0),
    ],
)
def test_setting_without_a_meaning_is_refused_by_name(name: str, value: float):
    with pytest.raises(ConfigError, match=rf"{name} is {value}"):
        MpcConfig(**{name: value})
