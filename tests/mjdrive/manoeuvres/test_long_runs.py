"""Short versions of what `mjdrive car test` does for long: nothing breaks, the bytes are the same, bars are found out."""

import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Action, Town
from mjdrive.manoeuvres import (
    barriers,
    cost,
    determinism,
    own_bars,
    ramming,
    random_driving,
    suite,
    town_moves,
)
from mjdrive.manoeuvres.bars import failed
from mjdrive.manoeuvres.cost import Cost
from mjdrive.manoeuvres.energy import EnergyMeter, GainWatch, WorkMeter
from mjdrive.manoeuvres.ramming import Ram, RammingGround
from mjdrive.manoeuvres.random_driving import RandomDrive
from mjdrive.manoeuvres.rig import GRAVITY, Rig
from mjdrive.simulation.simulation import Simulation
from mjdrive.town.lane_graph import lane_length
from mjdrive.vehicle import cars
from mjdrive.vehicle.car import Car

TIGHTEST = 4
GOOD_RAM = Ram("pole_1", 0.1, 0.0, 0.0, 0.5, -0.016, 0, is_finite=True)


@pytest.fixture(scope="module")
def ground(town02: Town) -> RammingGround:
    return RammingGround(town02)


@pytest.mark.parametrize("name", cars.SHIPPED)
def test_random_driving_breaks_nothing_and_makes_no_energy(name):
    car = cars.load(name)
    drives = [random_driving.drive_randomly(seed, car=car.path, duration=20.0) for seed in (1, 2)]
    assert failed(own_bars.of_car(random_driving.bars(drives, 20.0), car)) == ()
    assert max(drive.largest_roll for drive in drives) > 1.0  # it was wild


@pytest.mark.parametrize(
    "broken",
    [
        {"largest_gain": 6.0},
        {"largest_roll": 60.0},
        {"final_speed": 0.1},
        {"num_warnings": 1},
        {"is_finite": False},
    ],
)
def test_one_bad_seed_of_many_is_found_out(broken):
    good = RandomDrive(0, 0.0, 5.0, 0.0, 0, is_finite=True)
    assert failed(random_driving.bars([good, good])) == ()
    assert len(failed(random_driving.bars([good, good._replace(**broken)]))) == 1


def test_random_actions_are_the_seeds_and_cover_the_pedals():
    actions = random_driving.random_actions(np.random.default_rng(3), 200.0)
    assert actions == random_driving.random_actions(np.random.default_rng(3), 200.0)
    assert actions != random_driving.random_actions(np.random.default_rng(4), 200.0)
    assert len(actions) == 2000
    pedals, steering = np.array([(it.acceleration, it.steering) for it in actions]).T
    assert pedals.min() < -0.8
    assert pedals.max() > 0.8
    assert (pedals == 0.0).any()
    assert np.ptp(steering) > 1.5


@pytest.mark.parametrize(("pedal", "steering"), [(1.0, 0.0), (0.0, 1.0), (-1.0, -1.0)])
def test_work_of_engine_and_rack_is_no_energy_from_nowhere(pedal, steering):
    """Ten steps: the car is driven on, or its rack turned at a standstill, which alone used to count as a gain of 10 J."""
    rig = Rig.of_car(cars.load("mkz").path, timestep=0.00125)
    meter = EnergyMeter(rig.model, rig.data, rig.car)
    rig.place()
    before, work = meter.read(), WorkMeter(rig.model, rig.data)
    rig.car.command(Action(pedal, steering))
    gained, done = [], []
    for _ in range(10):
        random_driving.advance(rig, work.note)
        gained.append(meter.read() - before)
        done.append(work.total)
    assert max(done) > 5.0
    assert max(gained) > 5.0  # what was done is seen
    assert max(np.diff(np.array(gained) - done)) < 0.1


def test_push_that_no_actuator_gave_is_energy_from_nowhere(monkeypatch):
    update = Car.update

    def pushed(car: Car) -> None:
        update(car)
        car._data.body("car").xfrc_applied[0] += 500.0

    honest = random_driving.drive_randomly(1, duration=3.0)
    monkeypatch.setattr(Car, "update", pushed)
    helped = random_driving.drive_randomly(1, duration=3.0)
    assert honest.largest_gain < random_driving.MOST_GAIN < helped.largest_gain


def test_energy_of_a_rolling_car_is_that_of_its_mass_and_wheels(rig):
    speed = 20.0
    meter = EnergyMeter(rig.model, rig.data, rig.car)
    rig.place()
    at_rest = meter.read()
    rig.place(speed=speed)
    parameters = rig.car.parameters
    wheels = 4 * parameters.wheel_inertia / parameters.wheel_radius**2
    expected = 0.5 * (parameters.mass + wheels) * speed**2
    assert meter.read() - at_rest == pytest.approx(expected, rel=0.01)


def test_energy_counts_what_the_tyres_carry(rig):
    meter = EnergyMeter(rig.model, rig.data, rig.car)
    parameters = rig.car.parameters
    rig.place()
    on_tyres = meter.read()
    per_wheel = parameters.mass * GRAVITY / 4
    stored = 4 * 0.5 * per_wheel**2 / parameters.tyre_vertical_stiffness
    assert on_tyres - float(rig.data.energy.sum()) == pytest.approx(stored, rel=0.05)


def test_every_kind_of_obstacle_stops_the_car(ground):
    rams = ramming.ram_all(ground, per_kind=1)
    assert set(rams) == set(ramming.KINDS)
    assert failed(ramming.bars(rams)) == ()
    for kind, (ram,) in rams.items():
        assert ram.obstacle.startswith(kind)
        assert ram.depth > 0.001  # it was hit


@pytest.mark.parametrize(
    "broken",
    [
        {"depth": 0.5},
        {"gain": 1.0},
        {"final_speed": 1.0},
        {"num_warnings": 1},
        {"is_finite": False},
    ],
)
def test_one_bad_impact_is_found_out(broken):
    assert failed(ramming.bars({"pole": [GOOD_RAM]})) == ()
    assert len(failed(ramming.bars({"pole": [GOOD_RAM, GOOD_RAM._replace(**broken)]}))) == 1


@pytest.mark.parametrize(
    ("readings", "gained"),
    [
        ([(10.0, True), (4.0, False), (9.0, False), (9.0, True)], 0.0),  # the obstacle gives back
        ([(10.0, True), (4.0, False), (12.0, False), (3.0, True)], 2.0),  # more than it was given
        ([(10.0, True), (4.0, False), (3.0, True), (4.5, True)], 1.5),  # coasting after the impact
        ([(10.0, True), (3.0, True), (2.0, False), (8.0, True)], 5.0),  # second impact
    ],
)
def test_energy_gained_after_an_impact_is_not_hidden_by_what_the_impact_took(readings, gained):
    watch = GainWatch()
    for energy, is_complete in readings:
        watch.note(energy, is_complete=is_complete)
    assert watch.largest == gained


def test_push_after_the_impact_is_found_out(ground, monkeypatch):
    """Something drives the car on while it rolls back from the pole; it stays slower than it came."""
    update = Car.update

    def pushed(car: Car) -> None:
        update(car)
        if 0.6 < car._data.time < 0.9:
            velocity = car._data.qvel[:2]
            car._data.body("car").xfrc_applied[:2] = 5000.0 * velocity / np.hypot(*velocity)

    (pole,) = ground.obstacles("pole", 1)
    honest = ground.ram(pole)
    monkeypatch.setattr(Car, "update", pushed)
    helped = ground.ram(pole)
    assert honest.gain < ramming.MOST_GAIN < helped.gain
    assert helped.gain < 100.0  # never above the energy of the approach


@pytest.mark.parametrize(
    "broken",
    [
        {"final_lean": 40.0},
        {"final_height": -0.2},
        {"final_height": float("nan")},
        {"gain": float("nan")},
    ],
)
def test_kerb_that_swallows_or_overturns_the_car_is_found_out(broken):
    assert failed(ramming.bars({"kerb": [GOOD_RAM]})) == ()
    found = failed(ramming.bars({"kerb": [GOOD_RAM, GOOD_RAM._replace(**broken)]}))
    assert "kerbs that are the end" in [bar.figure for bar in found]


def test_a_kind_that_was_never_hit_is_no_proof():
    assert [bar.figure for bar in failed(ramming.bars({"pole": [GOOD_RAM], "tree": []}))] == [
        "depth in tree, deepest of 0"
    ]


def test_barriers_stand_across_lanes(town02):
    town = barriers.with_barriers(town02, 8)
    assert len(town.objects) >= 8
    for barrier in town.objects:
        x, y = barrier.outline.T
        area = 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))
        assert area == pytest.approx(6.0 * 0.5)  # counter-clockwise


def test_tightest_moves_of_town02_can_be_driven(simulation: Simulation):
    town = simulation.town
    names = town_moves.moves(town)
    assert len(names) == 48
    tightest = sorted(names, key=lambda name: lane_length(town.lanes[name]))[:TIGHTEST]
    drives = town_moves.drive_moves(simulation, tightest)
    assert failed(town_moves.bars(drives)) == ()


def test_move_that_cannot_be_driven_is_named(town02):
    clean = town_moves.MoveDrive("a", (), 0.1, arrived=True)
    stuck = clean._replace(lane="b", arrived=False)
    kerb = clean._replace(lane="c", breaches=("kerb (kerb)",))
    (bar,) = failed(town_moves.bars([clean, stuck, kerb]))
    assert bar.measured == 2
    assert bar.reason == "b: never arrived; c: kerb (kerb)"


def test_route_over_a_move_begins_before_and_ends_after_the_junction(town02):
    for name in town_moves.moves(town02):
        before, move, after = town_moves.route_over(town02, name).lanes
        assert move == name
        assert town02.lanes[before].junction is None
        assert town02.lanes[after].junction is None


def test_same_seed_gives_the_same_bytes_wherever_it_drives():
    assert failed(determinism.bars(duration=4.0)) == ()


def test_longer_drive_has_another_digest():
    assert determinism.digest(duration=2.0) != determinism.digest(duration=2.1)


def test_cost_counts_the_physics_of_every_step(simulation: Simulation, monkeypatch):
    monkeypatch.setattr(cost, "NUM_STEPS", 5)
    monkeypatch.setattr(cost, "NUM_ROUNDS", 2)
    steps = []
    step = mujoco.mj_step
    monkeypatch.setattr(mujoco, "mj_step", lambda *args: (steps.append(args[2]), step(*args)))
    measured = cost.measure(simulation.town)
    assert sum(steps) == 3 * 5 * 20  # once to record, twice to repeat
    assert 0.0 < measured.best_ms <= measured.median_ms


def test_cost_is_the_mean_of_a_whole_round(simulation: Simulation, monkeypatch):
    """The clock ticks 4 ms in the first of three rounds, 1 ms in the second, 3 ms in the third."""
    monkeypatch.setattr(cost, "NUM_STEPS", 5)
    monkeypatch.setattr(cost, "NUM_ROUNDS", 3)
    ticks = iter([0.0, 0.004, 0.010, 0.011, 0.020, 0.023])
    monkeypatch.setattr(cost.time, "thread_time", lambda: next(ticks))
    measured = cost.measure(simulation.town)
    assert measured == pytest.approx((1.0 / 5, 3.0 / 5))


def test_slow_best_round_is_found_out():
    assert failed(cost.bars(Cost(0.5, 0.9))) == ()
    (bar,) = failed(cost.bars(Cost(0.7, 0.9)))
    assert "0.90 ms" in bar.reason


def test_rig_and_town_have_the_same_car(simulation: Simulation):
    assert Rig.of_car().car.parameters == simulation.car.parameters


def test_full_plan_is_that_of_the_issue():
    plan = suite.Plan()
    assert (plan.num_seeds, plan.random_duration) == (20, 1000.0)
