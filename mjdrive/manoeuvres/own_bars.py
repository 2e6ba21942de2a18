"""Bars that hang on what a car is meant to be: each car may have its own; all others hold for every car."""

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from mjdrive.manoeuvres import random_driving
from mjdrive.manoeuvres.bars import Bar, around
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel

TIME = "0 to 100 km/h"
RADIUS = "radius at full lock"
OF_THE_DEFAULT_CAR = (TIME, RADIUS, random_driving.GAIN)
"""Figures of such bars; the manoeuvres give them the limits of the default car."""

CARLA_TIME = 7.5  # of CARLA's Lincoln from 0 to 100 km/h, see docs/cars.md [s]
CARLA_RADIUS = 3.44  # of its rear axle: 3.72 m half way between axles that are 2.84 m apart [m]
SHARE = 0.05  # by which the mkz may differ from it [-]
MKZ_RACK = 10.0  # what rack and front wheels of the mkz have when they turn at 1.72 rad/s [J]


class _Limits(NamedTuple):
    """Limits in place of those of the default car.

    Attributes:
        least: As in `Bar`.
        most: As in `Bar`.
        reason: As in `Bar`.
    """

    least: float | None
    most: float
    reason: str


def _near(value: float, share: float, reason: str) -> _Limits:
    limits = around(value, share)
    return _Limits(limits["least"], limits["most"], reason)


_OWN = {
    cars.DEFAULT: {},
    "mkz": {
        TIME: _near(CARLA_TIME, SHARE, "CARLA's car 7.5 s, within 5 %"),
        RADIUS: _near(CARLA_RADIUS, SHARE, "CARLA's car 3.44 m, within 5 %"),
        # It starts and stops within three steps of the physics; half of the timestep leaves a tenth of the error.
        random_driving.GAIN: _Limits(None, MKZ_RACK, "in 0.1 s; energy of the rack at full rate"),
    },
}


def of_car(bars: Iterable[Bar], car: CarModel) -> tuple[Bar, ...]:
    """Put the limits of a car in place of those of the default car.

    Args:
        bars: As the manoeuvres give them.
        car: What drove.

    Returns:
        The bars; for a car that did not come with mjdrive they stay, and say for which car they were made.
    """
    return tuple(_own(bar, car) for bar in bars)


def _own(bar: Bar, car: CarModel) -> Bar:
    if bar.figure not in OF_THE_DEFAULT_CAR:
        return bar
    if car.name not in _OWN:
        return replace(bar, reason=f"{bar.reason}; a bar of the default car")
    own = _OWN[car.name].get(bar.figure)
    return bar if own is None else replace(bar, **own._asdict())
