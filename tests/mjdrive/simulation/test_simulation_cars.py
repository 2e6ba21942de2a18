"""One town, several cars."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from mjdrive.datatypes import Action, InfractionKind, Signal, Town, VehicleState
from mjdrive.errors import CarError
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_path


@pytest.fixture(scope="module")
def mkz(town02: Town) -> Simulation:
    return Simulation(town02, car=cars.load("mkz"))


def place(simulation: Simulation) -> None:
    simulation.reset(lane=sorted(simulation.town.lanes)[0], station=1.0, seed=0)


def first_red_step(simulation: Simulation) -> float:
    """How far the rear axle is past a stop line when a slow car is found guilty of running it [m]."""
    town = simulation.town
    light = next(iter(town.lights.values()))
    forward = np.array([np.cos(light.yaw), np.sin(light.yaw)])
    middle = light.stop_line.mean(axis=0)
    shown: Mapping[str, Signal] = dict.fromkeys(town.lights, Signal.RED)
    simulation._rules.reset()
    for ahead in np.arange(-4.0, 6.0, 0.02):
        x, y = middle + ahead * forward
        state = VehicleState(float(x), float(y), light.yaw, 1.0, 0.0, 0.0)
        found = simulation._rules.check(time=0.0, vehicle=state, lights=shown, hits=())
        if any(infraction.kind is InfractionKind.RED_LIGHT for infraction in found):
            return float(ahead)
    raise AssertionError("the red light was never run")


def test_car_of_the_simulation_is_the_one_that_was_asked_for(mkz):
    assert mkz.car_model.name == "mkz"
    assert mkz.car.parameters == cars.load("mkz").parameters
    assert mkz.car.parameters.mass == pytest.approx(1696)


def test_default_car_is_the_one_of_before_one_could_choose(simulation):
    assert simulation.car_model == cars.load()


def test_rules_know_the_size_of_the_car(mkz, simulation):
    # The tail begins 0.8 half lengths behind the middle of the car.
    expected = {}
    for world in (mkz, simulation):
        car = world.car.parameters
        middle_ahead = 0.5 * car.length - car.rear_overhang
        expected[world] = 0.8 * 0.5 * car.length - middle_ahead
        assert first_red_step(world) == pytest.approx(expected[world], abs=0.03)
    assert expected[mkz] != pytest.approx(expected[simulation], abs=0.05)


def test_same_actions_move_different_cars_differently(mkz, simulation):
    speeds = []
    for world in (mkz, simulation):
        place(world)
        for _ in range(10):
            world.step(Action(acceleration=1.0, steering=0.0))
        speeds.append(world.vehicle.speed)
    assert speeds[0] > speeds[1] + 1.0


def test_snapshot_brings_back_the_same_future_bit_by_bit(mkz):
    place(mkz)
    snapshot = mkz.save()
    futures = []
    for _ in range(2):
        mkz.restore(snapshot)
        for _ in range(20):
            mkz.step(Action(acceleration=0.9, steering=0.1))
        futures.append(mkz.save().physics)
    assert np.array_equal(*futures)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<asset>", '<asset><material name="asphalt"/>'),
        ('<geom class="shown" type="box" pos="3.46 .48', '<geom name="road" class="shown" type="box" pos="3.46 .48'),
    ],
)  # fmt: skip
def test_name_that_the_town_needs_is_refused(town02, tmp_path: Path, old, new):
    path = tmp_path / "my_car.xml"
    path.write_text(car_path().read_text().replace(old, new))
    with pytest.raises(CarError, match=r"repeated name .(asphalt|road)"):
        Simulation(town02, car=cars.load(path))


def test_defaults_of_a_car_do_not_reach_the_town(town02, mkz):
    """Everything in the town is the same world around another car."""
    settings = library.load_settings(town02.name)
    worlds = [Simulation(town02, settings=settings).model, mkz.model]
    things = []
    for model in worlds:
        town = [
            model.geom(number) for number in range(model.ngeom) if model.geom_bodyid[number] == 0
        ]
        things.append(
            [
                (g.name, g.pos.tolist(), g.size.tolist(), int(g.contype[0]), g.friction.tolist())
                for g in town
            ]
        )
    assert things[0] == things[1]
