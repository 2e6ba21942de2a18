"""Every number of the settings is finite, whatever it is for."""

import dataclasses
import math

import pytest

from mjdrive.config import (
    BevConfig,
    CameraConfig,
    CollectConfig,
    DisturbanceConfig,
    MpcConfig,
    PidConfig,
    RewardConfig,
    RulesConfig,
    SimulationConfig,
    TuneConfig,
)
from mjdrive.config.ranges import NOT_NEGATIVE, POSITIVE, SHARE
from mjdrive.errors import ConfigError

KINDS = (
    BevConfig, CameraConfig, CollectConfig, DisturbanceConfig, MpcConfig, PidConfig, RewardConfig, RulesConfig,
    SimulationConfig, TuneConfig,
)  # fmt: skip
NUMBERS = [
    pytest.param(kind, field.name, id=f"{kind.__name__}.{field.name}")
    for kind in KINDS
    for field in dataclasses.fields(kind)
    if type(field.default) is float
]


@pytest.mark.parametrize(("kind", "name"), NUMBERS)
def test_what_is_no_number_is_refused_by_name(kind: type, name: str):
    with pytest.raises(ConfigError, match=rf"{name}\b.* is nan"):
        kind(**{name: math.nan})


@pytest.mark.parametrize(
    ("allowed", "value", "holds"),
    [
        (POSITIVE, 0.0, False),
        (POSITIVE, 1e-9, True),
        (POSITIVE, math.inf, False),
        (NOT_NEGATIVE, 0.0, True),
        (NOT_NEGATIVE, -1e-9, False),
        (SHARE, 1.0, True),
        (SHARE, 1.1, False),
        (SHARE, math.nan, False),
    ],
)
def test_ranges_hold_what_they_say(allowed, value: float, holds: bool):
    assert allowed.holds(value) is holds


def test_timestep_of_zero_is_refused_not_divided_by():
    with pytest.raises(ConfigError, match=r"timestep is 0\.0; expected a positive number"):
        SimulationConfig(timestep=0.0)


def test_times_that_are_all_negative_are_refused():
    with pytest.raises(ConfigError, match=r"timestep is -0\.005"):
        SimulationConfig(timestep=-0.005, control_interval=-0.1, car_update_interval=-0.02)
