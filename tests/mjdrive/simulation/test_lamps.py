from dataclasses import replace

import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Signal, Town, TrafficLight
from mjdrive.simulation.lamps import DARK, LIT, add_lights, set_lamps
from mjdrive.simulation.palette import add_materials
from mjdrive.vehicle.assembly import car_on_road


def light(name: str, x: float) -> TrafficLight:
    return TrafficLight(
        id=name,
        lane="0",
        junction="0",
        stop_line=np.array([[x, 2.0], [x, -2.0]]),
        yaw=0.0,
        pole=np.array([x, -3.0]),
        program=((Signal.GREEN, 1.0),),
        offset=0.0,
    )


@pytest.fixture
def town() -> Town:
    lights = {name: light(name, x) for name, x in (("a", 10.0), ("b", 20.0), ("c", 30.0))}
    return Town(name="t", lanes={}, lights=lights, bounds=np.zeros(4), digest="")


@pytest.fixture
def model(town) -> mujoco.MjModel:
    spec = car_on_road(timestep=0.005)
    add_materials(spec)
    add_lights(spec, town.lights.values(), height=4.5)
    spec.worldbody.add_geom(name="last", size=[1, 1, 1])
    return spec.compile()


def test_each_light_shows_its_signal_and_nothing_else(model, town):
    signals = {"a": Signal.RED, "b": Signal.GREEN, "c": Signal.YELLOW}
    set_lamps(model, town, signals)
    for name, shown in signals.items():
        for signal in Signal:
            lamp = model.geom(f"lamp_{name}_{signal.name.lower()}")
            expected = LIT[signal] if signal == shown else DARK[signal]
            assert lamp.rgba == pytest.approx(expected, abs=1e-6)


def test_only_lamps_change_colour(model, town):
    before = model.geom_rgba.copy()
    set_lamps(model, town, dict.fromkeys(town.lights, Signal.RED))
    changed = np.flatnonzero(np.any(model.geom_rgba != before, axis=1))
    assert {model.geom(index).name for index in changed} == {f"lamp_{name}_red" for name in "abc"}


def test_lamps_face_the_approaching_driver(model):
    assert (
        model.geom("lamp_a_red").pos[0] < model.geom("head_a").pos[0] < model.geom("pole_a").pos[0]
    )


def test_town_without_lights_has_nothing_to_set(model, town):
    dark_town = Town(name="t", lanes={}, lights={}, bounds=np.zeros(4), digest="")
    before = model.geom_rgba.copy()
    set_lamps(model, dark_town, {})
    assert np.array_equal(model.geom_rgba, before)


def test_lights_of_one_signal_share_pole_and_head_and_are_seen_once(town):
    lights = [light("a", 10.0), light("a2", 10.0), light("b", 20.0)]
    spec = car_on_road(timestep=0.005)
    add_materials(spec)
    add_lights(spec, lights, height=4.5)
    model = spec.compile()
    names = {model.geom(index).name for index in range(model.ngeom)}
    assert {"pole_a", "pole_b", "head_a", "head_b"} <= names
    assert not {"pole_a2", "head_a2"} & names
    assert model.geom("lamp_a_red").group == 1
    assert model.geom("lamp_a2_red").group == 3
    set_lamps(
        model,
        replace(town, lights={each.id: each for each in lights}),
        {"a": Signal.RED, "a2": Signal.RED, "b": Signal.GREEN},
    )
    assert model.geom("lamp_a2_red").rgba == pytest.approx(LIT[Signal.RED], abs=1e-6)
