"""3000 control steps in which a learned policy decides at each: 300 s of driving.

The networks have first weights, so that no training stands before the figures; for the car to get about in the town all
the same, the action that is driven is the PID expert's. Each step so contains all of a step of `mjdrive drive` (physics,
rules, bird's-eye view, decision, recording) and an expert besides.
"""

from collections.abc import Callable

import torch

from mjdrive.benchmarks.comparison import Figure, Plan
from mjdrive.benchmarks.decisions import network, sampler
from mjdrive.benchmarks.timing import WALL, timed
from mjdrive.datatypes import Observation, Policy
from mjdrive.episodes import driving
from mjdrive.learning.pilot import Pilot
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from models import presets
from models.hardware import choose_device
from models.interfaces import Learner
from models.learners import build_learner

NUM_STEPS = 3000
QUICK_STEPS = 150
"""Control steps that are driven for a quick look [-]."""

MOST_S = {"dfo": 300.0, "grid": 60.0, "bc": 30.0}
"""What 3000 steps may take [s]."""


def measure(plan: Plan) -> tuple[Figure, ...]:
    """Drive with each way to decide.

    Args:
        plan: How much to measure.
    """
    ways: dict[str, tuple[str, Learner]] = {
        "dfo": ("DA-IBC, paper's DFO", network(sampler("dfo"))),
        "grid": ("DA-IBC, grid of 128 x 128", network(sampler("grid"))),
        "bc": ("BC-Beta, mode", build_learner(presets.paper("bc-beta"), seed=0)),
    }
    num_steps = QUICK_STEPS if plan.quick else NUM_STEPS
    simulation = Simulation(library.load("town02"))
    note = (
        f"Real time is 300 s. One round; untrained networks decide, the PID expert's action is driven. Wall time; "
        f"threads: {torch.get_num_threads()}; networks on {choose_device()}."
    )
    if plan.quick:
        note += f" From {num_steps} steps."
    figures = []
    for key, (name, learner) in ways.items():
        plan.on_stage(name)
        seconds = timed(drive(simulation, Pilot(learner, name=name), num_steps=num_steps), WALL)
        figures.append(
            Figure(
                name=f"closed loop, {name}",
                work=f"{NUM_STEPS} control steps in town02",
                rounds=(seconds * NUM_STEPS / num_steps,),
                unit="s",
                most=MOST_S[key],
                note=note,
            )
        )
    return tuple(figures)


def drive(
    simulation: Simulation, policy: Policy[Observation], *, num_steps: int
) -> Callable[[], object]:
    """A drive in which a learned policy decides at every step and the PID expert's action is driven.

    Args:
        simulation: World to drive in.
        policy: Who decides.
        num_steps: Control steps [-].
    """
    policy.reset(0)

    def decide(_: int) -> None:
        policy.act(simulation.observe())

    return lambda: driving.drive_expert(
        simulation,
        num_steps=num_steps,
        seed=0,
        on_step=decide,
    )
