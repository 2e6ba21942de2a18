"""A control step with rules and the bird's-eye view, against the bare `mj_step` calls in it, and where the rest goes."""

from typing import NamedTuple

import mujoco

from mjdrive.benchmarks.bev import on_one_thread
from mjdrive.benchmarks.comparison import Comparison, Figure, Plan, Reads, Row
from mjdrive.benchmarks.our_world import TownDrive
from mjdrive.benchmarks.timing import THREAD, cost_of
from mjdrive.datatypes import Action
from mjdrive.simulation.contacts import ContactWatch
from mjdrive.simulation.simulation import Simulation

ROUTE = "route1"
NUM_STEPS = 600
MOST = 1.5
"""How many times the physics alone a control step may take [-]."""


class Whole(NamedTuple):
    """Processor time of some control steps.

    Attributes:
        step: Of `Simulation.step` [s].
        observe: Of `Simulation.observe` [s].
    """

    step: float
    observe: float


class Physics(NamedTuple):
    """Processor time of the same steps without rules, lights and views.

    Attributes:
        mj_step: Of the calls of `mj_step` [s].
        car: Of brakes, air drag and tyres between them [s].
        contacts: Of reading what the car touches [s].
    """

    mj_step: float
    car: float
    contacts: float


def measure(plan: Plan) -> tuple[Row, ...]:
    """Drive the same steps twice in turns: all of a step, and its physics alone.

    Args:
        plan: How much to measure.
    """
    drive = TownDrive(ROUTE)
    with on_one_thread():
        num_rounds = plan.rounds(15)
        pairs = [_both(drive) for _ in range(num_rounds + 1)][1:]  # the first one warms up
    comparison = Comparison(
        name="control step",
        work="0.1 s of driving in town02 on one core",
        ours="step with rules, and observation of 192 x 192 x 5",
        theirs="the mj_step calls in it alone",
        our_rounds=tuple(whole.step + whole.observe for whole, _ in pairs),
        their_rounds=tuple(physics.mj_step for _, physics in pairs),
        bar=MOST,
        reads=Reads.COST,
        pieces=NUM_STEPS,
        piece="step",
        note="Processor time. The rows below it say where what is beyond the physics goes.",
    )
    parts = {
        "brakes, drag and tyres, 5 times": [physics.car for _, physics in pairs],
        "reading contacts, 5 times": [physics.contacts for _, physics in pairs],
        "rules, lights, and what the caches lost": [
            whole.step - sum(physics) for whole, physics in pairs
        ],
        "observation": [whole.observe for whole, _ in pairs],
    }
    return comparison, *(_share(name, seconds) for name, seconds in parts.items())


def _share(name: str, seconds: list[float]) -> Figure:
    return Figure(
        name=f"control step: {name}",
        work="of a control step",
        rounds=tuple(1e6 * it / NUM_STEPS for it in seconds),
        unit="us",
    )


def _both(drive: TownDrive) -> tuple[Whole, Physics]:
    actions = drive.actions[:NUM_STEPS]
    drive.start()
    whole = step_seconds(drive.simulation, actions)
    drive.start()
    return whole, physics_seconds(drive.simulation, actions)


def step_seconds(simulation: Simulation, actions: list[Action]) -> Whole:
    """Time all of some steps.

    Args:
        simulation: Where they begin.
        actions: What is done.
    """
    step = observe = 0.0
    for action in actions:
        begin = THREAD()
        simulation.step(action)
        between = THREAD()
        simulation.observe()
        observe += THREAD() - between
        step += between - begin
    return Whole(step, observe)


def physics_seconds(simulation: Simulation, actions: list[Action]) -> Physics:
    """Repeat the physics of some steps by the clock; what asking it takes does not count.

    Args:
        simulation: Where they begin.
        actions: What is done.
    """
    asking = cost_of(THREAD)
    config, car = simulation.config, simulation.car
    watch = ContactWatch(simulation.model, simulation.data)
    num_updates = round(config.control_interval / config.car_update_interval)
    num_substeps = round(config.car_update_interval / config.timestep)
    mj_step = update = contacts = 0.0
    for action in actions:
        car.command(action)
        for _ in range(num_updates):
            times = [THREAD()]
            car.update()
            times.append(THREAD())
            mujoco.mj_step(simulation.model, simulation.data, num_substeps)
            times.append(THREAD())
            if not car.is_clear:
                watch.hits()
            times.append(THREAD())
            update += times[1] - times[0] - asking
            mj_step += times[2] - times[1] - asking
            contacts += times[3] - times[2] - asking
    return Physics(mj_step, update, contacts)
