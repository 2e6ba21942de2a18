"""Contacts are looked for wherever there are any, and what the car does never depends on it."""

import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Action
from mjdrive.vehicle.assembly import OBSTACLE_BITS, car_on_road
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.surroundings import Surroundings

WALL_X = 40.0


def ground_spec() -> mujoco.MjSpec:
    """The car before a wall across its way."""
    spec = car_on_road(timestep=0.005)
    contype, conaffinity = OBSTACLE_BITS
    spec.worldbody.add_geom(
        name="building_0",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[0.5, 10.0, 2.0],
        pos=[WALL_X, 0.0, 2.0],
        contype=contype,
        conaffinity=conaffinity,
    )
    return spec


def ground_with_wall(*, always: bool = False, ball: bool = False) -> tuple[mujoco.MjData, Car]:
    """That scene, the car at rest; `always` looks for contacts at every step."""
    spec = ground_spec()
    if ball:
        body = spec.worldbody.add_body(pos=[0.0, 20.0, 0.5])
        body.add_freejoint()
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.5, 0, 0], contype=1, conaffinity=2)
    model = spec.compile()
    data = mujoco.MjData(model)
    car = Car(model, data)
    if always:
        car._surroundings._is_alone = False
    car.place(0.0, 0.0, 0.0)
    return data, car


def looks(data: mujoco.MjData) -> bool:
    return bool(data.model.body_contype[0])


def drive(data: mujoco.MjData, car: Car, action: Action, duration: float) -> None:
    car.command(action)
    for _ in range(round(duration / 0.02)):
        car.update()
        mujoco.mj_step(data.model, data, 4)


@pytest.mark.parametrize("steering", [0.0, 0.15])
def test_crash_is_the_same_bit_by_bit_as_if_contacts_were_always_looked_for(steering):
    states = []
    for always in (False, True):
        data, car = ground_with_wall(always=always)
        car.place(0.0, 0.0, 0.0, speed=12.0)
        drive(data, car, Action(0.3, steering), 6.0)
        states.append(np.concatenate([data.qpos, data.qvel]))
    assert np.array_equal(*states)
    assert states[0][0] < WALL_X - 3.0  # it was a crash


def test_far_from_everything_nothing_is_looked_for():
    data, car = ground_with_wall()
    car.update()
    assert not looks(data)
    assert data.ncon == 4  # the tyres stand on the road all the same


@pytest.mark.parametrize("yaw", [0.0, 1.0, np.pi / 2, 2.5, -2.0])
def test_near_a_wall_contacts_are_looked_for(yaw):
    data, car = ground_with_wall()
    nearest = float((car.footprint() @ [np.cos(yaw), -np.sin(yaw)]).max())
    car.place(WALL_X - 0.5 - nearest - 0.1, 0.0, yaw)
    assert looks(data)
    car.place(WALL_X - 0.5 - nearest - 2.0, 0.0, yaw)
    assert not looks(data)


def test_fast_car_looks_further_ahead():
    data, car = ground_with_wall()
    nose = float(car.footprint()[:, 0].max())
    for speed, expected in ((0.0, False), (20.0, True)):
        car.place(WALL_X - 0.5 - nose - 1.5, 0.0, 0.0, speed=speed)
        assert looks(data) is expected


def test_boxes_in_reach_are_those_of_the_whole_world_wherever_the_car_has_been():
    """Jumps short and long among scattered blocks: the list of those around the car hides none."""
    rng = np.random.default_rng(0)
    spec = car_on_road(timestep=0.005)
    contype, conaffinity = OBSTACLE_BITS
    blocks = rng.uniform(-60.0, 60.0, (60, 2))
    for x, y in blocks:
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.5, 0.5, 0.5], pos=[x, y, 0.5],
            contype=contype, conaffinity=conaffinity,
        )  # fmt: skip
    model = spec.compile()
    bits = int(model.body_contype[0]), int(model.body_conaffinity[0])
    assert any(bits)
    data = mujoco.MjData(model)
    car = Car(model, data)
    answers = []
    x, y = 0.0, 0.0
    for jump in rng.choice([0.5, 5.0, 30.0], 400):
        x, y = np.clip(rng.normal((x, y), jump), -60.0, 60.0)
        data.qpos[:2] = x, y
        data.qvel[:2] = rng.normal(0.0, 10.0, 2)
        car.update()
        answers.append(looks(data))
        model.body_contype[0], model.body_conaffinity[0] = bits
        fresh = Surroundings(model, data)  # has been nowhere
        fresh.update(float(np.hypot(*data.qvel[:2])))
        assert looks(data) == answers[-1]
        distance = np.abs(blocks - (x, y)).max(axis=1).min()
        assert answers[-1] or distance > 0.5  # not within a block
    assert 40 < sum(answers) < 360


def test_roof_of_a_car_that_rolls_over_meets_the_road():
    data, car = ground_with_wall()
    data.qpos[2] = 1.5
    data.qpos[3:7] = 0.0, 1.0, 0.0, 0.0  # upside down
    drive(data, car, Action(0.0, 0.0), 2.0)
    assert looks(data)
    assert data.qpos[2] > 1.0  # it lies on its roof instead of falling through


def test_with_other_bodies_that_move_contacts_are_always_looked_for():
    data, car = ground_with_wall(ball=True)
    drive(data, car, Action(0.0, 0.0), 1.0)
    assert looks(data)
    assert data.qpos[-5] == pytest.approx(0.5, abs=0.05)  # the ball lies on the road


def test_restored_car_meets_the_wall_it_stood_at():
    data, car = ground_with_wall()
    nose = float(car.footprint()[:, 0].max())
    car.place(WALL_X - 0.5 - nose - 0.05, 0.0, 0.0, speed=5.0)
    saved = car.save()
    drive(data, car, Action(0.0, 0.0), 1.0)
    crashed = data.qpos.copy()
    car.place(0.0, 0.0, 0.0)
    assert not looks(data)
    car.restore(saved)
    assert looks(data)
    drive(data, car, Action(0.0, 0.0), 1.0)
    assert np.array_equal(data.qpos, crashed)


def test_walls_stand_where_they_belong_in_a_simulation_that_is_restored_first():
    data, car = ground_with_wall()
    nose = float(car.footprint()[:, 0].max())
    car.place(WALL_X - 0.5 - nose - 0.05, 0.0, 0.0, speed=5.0)
    saved = car.save()
    model = ground_spec().compile()
    fresh = mujoco.MjData(model)
    again = Car(model, fresh)
    again.restore(saved)  # without having been placed
    wall = model.geom("building_0").id
    assert fresh.geom_xpos[wall] == pytest.approx([WALL_X, 0.0, 2.0])
    drive(data, car, Action(0.0, 0.0), 1.0)
    drive(fresh, again, Action(0.0, 0.0), 1.0)
    assert np.array_equal(fresh.qpos, data.qpos)


def test_state_that_data_had_is_kept():
    model = car_on_road(timestep=0.005).compile()
    data = mujoco.MjData(model)
    data.qpos[:3] = 5.0, 6.0, 0.0
    data.time = 3.0
    car = Car(model, data)
    assert (car.state().x, car.state().y, data.time) == (5.0, 6.0, 3.0)
