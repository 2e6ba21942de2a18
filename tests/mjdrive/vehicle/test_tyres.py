"""The tyre law as numbers; what it does to the car is held by the manoeuvres."""

import numpy as np
import pytest

from mjdrive.vehicle import tyres
from mjdrive.vehicle.assembly import WHEELS


def friction_of_a_pair(ground, wheel: str) -> float:
    """R_f by the definitions at the top of the module, from what the model holds."""
    pair = ground.model.pair(f"tyre_{wheel}").id
    impedance = ground.model.pair_solimp[pair, 0]
    weight = ground.model.body_invweight0[ground.model.body(f"wheel_{wheel}").id, 0]
    return (1.0 - impedance) / impedance * weight / ground.model.opt.impratio


@pytest.mark.parametrize("speed", [0.5, 8.0, 30.0])
def test_slipping_tyre_has_its_cornering_stiffness(ground, speed):
    parameters = ground.car.parameters
    ground.car.place(0.0, 0.0, 0.0, speed=speed)
    stiffness = [parameters.cornering_stiffness_front] * 2
    stiffness += [parameters.cornering_stiffness_rear] * 2
    for wheel, expected in zip(WHEELS, stiffness, strict=True):
        pair = ground.model.pair(f"tyre_{wheel}").id
        impedance = ground.model.pair_solimp[pair, 0]
        damping = -ground.model.pair_solreffriction[pair, 1] / impedance
        rolling = ground.data.joint(f"spin_{wheel}").qvel[0] * parameters.wheel_radius
        assert rolling > speed  # a loaded wheel is smaller
        found = damping * rolling / friction_of_a_pair(ground, wheel)
        assert found == pytest.approx(expected)


def test_spring_of_a_tyre_does_not_hang_on_the_speed(ground):
    parameters = ground.car.parameters
    for speed in (0.0, 0.01, 3.0, 40.0):
        ground.car.place(0.0, 0.0, 0.0, speed=speed)
        for wheel in WHEELS:
            pair = ground.model.pair(f"tyre_{wheel}").id
            normal = friction_of_a_pair(ground, wheel) * ground.model.opt.impratio
            impedance = ground.model.pair_solimp[pair, 0]
            spring, damping = -ground.model.pair_solref[pair] / (normal * impedance)
            assert spring == pytest.approx(parameters.tyre_vertical_stiffness)
            assert damping == pytest.approx(parameters.tyre_vertical_damping)
            assert normal >= tyres.MIN_NORMAL_REGULARIZATION * (1 - 1e-9)


def test_a_stop_of_the_car_takes_the_law_to_its_lower_end(ground):
    ground.car.place(0.0, 0.0, 0.0)
    held = ground.model.opt.impratio
    ground.car.place(0.0, 0.0, 0.0, speed=0.5 * tyres.MIN_SPEED)
    assert ground.model.opt.impratio == held > tyres.IMPEDANCE_RATIO


def test_what_the_law_does_not_say_stays_as_the_car_has_it(ground):
    before = ground.model.pair_solimp.copy()
    ground.car.place(0.0, 0.0, 0.0, speed=10.0)
    assert np.array_equal(ground.model.pair_solimp[:, 2:], before[:, 2:])
    assert not np.array_equal(ground.model.pair_solimp[:, :2], before[:, :2])
