"""Every car is held to the bars of its kind."""

import dataclasses

import pytest

from mjdrive.manoeuvres import acceleration, handling, own_bars, random_driving, turning_circle
from mjdrive.manoeuvres.bars import Bar, failed
from mjdrive.manoeuvres.random_driving import RandomDrive
from mjdrive.manoeuvres.rig import Rig
from mjdrive.vehicle import cars
from mjdrive.vehicle.cars import CarModel


@pytest.fixture(scope="module")
def mkz_bars() -> tuple[Bar, ...]:
    """Of the two manoeuvres that have bars of a car's own, as they are driven by the mkz."""
    path = cars.load("mkz").path
    return (
        *acceleration.bars(acceleration.accelerate(Rig.of_car(path))),
        *turning_circle.bars(turning_circle.turn(Rig.of_car(path))),
    )


def mine() -> CarModel:
    return dataclasses.replace(cars.load("mkz"), name="my_car.xml")


def test_manoeuvres_have_the_bars_that_are_a_matter_of_the_car(driven: handling.Handling):
    still = RandomDrive(0, 0.0, 5.0, 0.0, 0, is_finite=True)
    bars = (*driven.bars(), *random_driving.bars([still]))
    found = [bar.figure for bar in bars if bar.figure in own_bars.OF_THE_DEFAULT_CAR]
    assert found == list(own_bars.OF_THE_DEFAULT_CAR)


def test_default_car_keeps_the_bars_of_the_manoeuvres(driven: handling.Handling):
    assert own_bars.of_car(driven.bars(), cars.load()) == driven.bars()


def test_mkz_is_held_against_carlas_car(mkz_bars):
    assert (
        len(failed(mkz_bars)) == 2
    )  # a car that is quicker and turns tighter than a family saloon
    own = own_bars.of_car(mkz_bars, cars.load("mkz"))
    assert failed(own) == ()
    assert [bar.measured for bar in own] == [bar.measured for bar in mkz_bars]
    assert all("CARLA's car" in bar.reason for bar in own)


def test_mkz_that_is_unlike_carlas_car_is_found_out(mkz_bars):
    slower = [dataclasses.replace(bar, measured=1.08 * bar.measured) for bar in mkz_bars]
    assert len(failed(own_bars.of_car(slower, cars.load("mkz")))) == 2


def test_car_of_ones_own_is_told_whose_bars_it_is_held_to(mkz_bars):
    other = Bar("braking", "50 to 0 km/h", 10.0, "m", 9.0, 11.0, "friction")
    *own, kept = own_bars.of_car((*mkz_bars, other), mine())
    assert kept == other
    assert [bar.reason.endswith("; a bar of the default car") for bar in own] == [True, True]
    assert [(bar.least, bar.most) for bar in own] == [(bar.least, bar.most) for bar in mkz_bars]
