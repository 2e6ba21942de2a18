"""A thousand seconds of random pedals and steering on the plane: nothing may break, no energy may come from nowhere."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Action
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.energy import EnergyMeter, WorkMeter
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL
from mjdrive.manoeuvres.rig import Rig
from mjdrive.vehicle import engine

DURATION = 1000.0  # [s]
NUM_SEEDS = 20
TOP_SPEED = 40.0  # above it the throttle is left alone [m/s]
LONGEST_HOLD = 30  # control steps for which an action may be held [-]
STOPPING_TIME = 15.0  # of full brake at the end [s]
MOST_GAIN = (
    5.0  # of energy in one control step beyond what engine and rack did: 0.3 mm of height [J]
)
MOST_ROLL = 45.0  # beyond it the car has rolled over [deg]
GAIN = "energy beyond the work of engine and rack"
_CONTROL = SimulationConfig().control_interval


class RandomDrive(NamedTuple):
    """What came of one seed.

    Attributes:
        seed: Of the actions.
        largest_gain: Of energy over one control step, beyond the work of the actuators in it [J].
        largest_roll: Lean of the body in any direction [deg].
        final_speed: After the car has been braked [m/s].
        num_warnings: That MuJoCo gave [-].
        is_finite: Whether all numbers were finite to the end.
    """

    seed: int
    largest_gain: float
    largest_roll: float
    final_speed: float
    num_warnings: int
    is_finite: bool


def random_actions(rng: np.random.Generator, duration: float) -> list[Action]:
    """Draw actions for each control step: half of the time throttle, a quarter brake, a quarter neither.

    Args:
        rng: Source of the draws.
        duration: How long they last [s].

    Returns:
        One action a control step, each held for a while.
    """
    num_steps = round(duration / _CONTROL)
    actions: list[Action] = []
    while len(actions) < num_steps:
        pedal = rng.choice([1.0, 1.0, -1.0, 0.0]) * rng.uniform(0.05, 1.0)
        steering = rng.choice([0.0, 0.1, 0.4, 1.0]) * rng.uniform(-1.0, 1.0)
        actions += [Action(float(pedal), float(steering))] * int(rng.integers(1, LONGEST_HOLD))
    return actions[:num_steps]


def drive_randomly(
    seed: int,
    *,
    car: Path | None = None,
    duration: float = DURATION,
    on_second: Callable[[], None] = lambda: None,
) -> RandomDrive:
    """Drive one seed and brake in the end.

    Args:
        seed: Of the actions.
        car: MJCF; the default car if None.
        duration: Of the random actions [s].
        on_second: Called after each second that has been simulated.
    """
    rig = Rig.of_car(car)
    meter = EnergyMeter(rig.model, rig.data, rig.car)
    rig.place()
    work = WorkMeter(rig.model, rig.data)
    warnings_before = engine.num_warnings(rig.data)
    largest_gain, most_upright, unexplained = 0.0, 1.0, meter.read()
    stop = [Action(-1.0, 0.0)] * round(STOPPING_TIME / _CONTROL)
    actions = random_actions(np.random.default_rng(seed), duration) + stop
    for number, action in enumerate(actions, start=1):
        pressed = action.acceleration if rig.moment().speed < TOP_SPEED else 0.0
        rig.car.command(Action(pressed, action.steering))
        advance(rig, work.note)
        before, unexplained = unexplained, meter.read() - work.total
        largest_gain = max(largest_gain, unexplained - before)
        most_upright = min(most_upright, upright(rig.data))
        if number % round(1.0 / _CONTROL) == 0:
            on_second()
    return RandomDrive(
        seed=seed,
        largest_gain=largest_gain,
        largest_roll=float(np.degrees(np.arccos(np.clip(most_upright, -1.0, 1.0)))),
        final_speed=float(np.abs(rig.data.qvel).max()),
        num_warnings=engine.num_warnings(rig.data) - warnings_before,
        is_finite=bool(np.isfinite(rig.data.qpos).all() and np.isfinite(rig.data.qvel).all()),
    )


def advance(rig: Rig, on_step: Callable[[], None] = lambda: None) -> None:
    """Simulate one control step.

    Args:
        rig: What drives.
        on_step: Called after each physics step.
    """
    steps = round(UPDATE_INTERVAL / rig.model.opt.timestep)
    for _ in range(round(_CONTROL / UPDATE_INTERVAL)):
        rig.car.update()
        for _ in range(steps):
            mujoco.mj_step(rig.model, rig.data)
            on_step()


def upright(data: mujoco.MjData) -> float:
    """Cosine of the angle between the car's vertical and the world's [-]."""
    quaternion = data.qpos[3:7]
    return float(1.0 - 2.0 * (quaternion[1] ** 2 + quaternion[2] ** 2))


def bars(drives: Sequence[RandomDrive], duration: float = DURATION) -> tuple[Bar, ...]:
    """Hold the worst of all seeds against the limits."""
    name = f"random actions, {len(drives)} x {duration:,.0f} s"
    broken = float(sum(not drive.is_finite for drive in drives))
    warnings = float(sum(drive.num_warnings for drive in drives))
    gain = max(drive.largest_gain for drive in drives)
    roll = max(drive.largest_roll for drive in drives)
    final = max(drive.final_speed for drive in drives)
    return (
        Bar(name, "drives that end in no number", broken, "drives", most=0.0),
        Bar(name, "warnings of MuJoCo", warnings, "warnings", most=0.0),
        Bar(name, GAIN, gain, "J", most=MOST_GAIN, reason="in 0.1 s"),
        Bar(name, "lean", roll, "deg", most=MOST_ROLL, reason="never rolls over"),
        Bar(name, "speed after braking", final, "m/s", most=0.02, reason="comes to rest"),
    )
