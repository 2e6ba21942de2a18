"""A control step with rules and the bird's-eye view, against the bare `mj_step` calls in it."""

import time

import mujoco

from mjdrive.benchmarks.bev import on_one_thread
from mjdrive.benchmarks.comparison import Comparison, Plan, Reads
from mjdrive.benchmarks.our_world import TownDrive
from mjdrive.benchmarks.timing import THREAD, timed
from mjdrive.datatypes import Action
from mjdrive.simulation.simulation import Simulation

ROUTE = "route1"
NUM_STEPS = 600
MOST = 1.5
"""How many times the physics alone a control step may take [-]."""


def measure(plan: Plan) -> tuple[Comparison, ...]:
    """Drive the same steps twice in turns: all of a step, and its physics alone.

    Args:
        plan: How much to measure.
    """
    drive = TownDrive(ROUTE)
    with on_one_thread():
        num_rounds = plan.rounds(15)
        pairs = [_both(drive) for _ in range(num_rounds + 1)][1:]  # the first one warms up
    ours, bare = zip(*pairs, strict=True)
    return (
        Comparison(
            name="control step",
            work="0.1 s of driving in town02 on one core",
            ours="step with rules, and observation of 192 x 192 x 5",
            theirs="the mj_step calls in it alone",
            our_rounds=ours,
            their_rounds=bare,
            bar=MOST,
            reads=Reads.COST,
            pieces=NUM_STEPS,
            piece="step",
            note="Processor time. The physics alone is timed where nothing else runs between its calls but the tyres.",
        ),
    )


def _both(drive: TownDrive) -> tuple[float, float]:
    """Processor time of all of the steps, and of the physics of the same [s]."""
    drive.start()
    whole = timed(lambda: _steps(drive.simulation, drive.actions[:NUM_STEPS]), THREAD)
    drive.start()
    return whole, physics_seconds(drive.simulation, drive.actions[:NUM_STEPS])


def _steps(simulation: Simulation, actions: list[Action]) -> None:
    for action in actions:
        simulation.step(action)
        simulation.observe()


def physics_seconds(simulation: Simulation, actions: list[Action]) -> float:
    """Repeat the physics of some steps and time the calls of `mj_step` alone [s].

    Args:
        simulation: Where the steps begin.
        actions: What was done.
    """
    config, car = simulation.config, simulation.car
    num_updates = round(config.control_interval / config.car_update_interval)
    num_substeps = round(config.car_update_interval / config.timestep)
    seconds = 0.0
    for action in actions:
        car.command(action)
        for _ in range(num_updates):
            car.update()
            begin = time.thread_time()
            mujoco.mj_step(simulation.model, simulation.data, num_substeps)
            seconds += time.thread_time() - begin
    return seconds
