"""A control step with its observation, beside those of other driving environments; one core each, in turns."""

import importlib.resources
import os
import sys
from dataclasses import dataclass
from pathlib import Path

from mjdrive.benchmarks.comparison import Comparison, NotMeasured, Plan, Row
from mjdrive.benchmarks.rival_process import Served, serve
from mjdrive.benchmarks.timing import Pair

CHECKOUT = Path(__file__).resolve().parents[2]
WORLDS = CHECKOUT / "scripts" / "bench" / "rivals"
INSTALL = "python scripts/bench/install_rivals.py"
OURS = "mjdrive, town02, 192 x 192 x 5"
ROUTE = "route1"


@dataclass(frozen=True, slots=True)
class Rival:
    """Another driving environment.

    Attributes:
        name: Of the row.
        environment: Folder of its virtual environment, and name of its file in scripts/bench/rivals.
        argument: What its world is made of.
        view: What it draws.
        bar: How many times faster we are to be [-].
        num_steps: Steps a round; half a second or so [-].
        note: How its work differs from ours.
    """

    name: str
    environment: str
    argument: str
    view: str
    bar: float
    num_steps: int
    note: str


METADRIVE = "10 steps a second as ours, rigid-body car in Bullet, no traffic, no lights, no rules but leaving the road"


def metadrive_84(plan: Plan) -> tuple[Row, ...]:
    """Compare with MetaDrive's top-down view of 84 x 84 x 5."""
    return (
        compare(plan, Rival("MetaDrive 84", "metadrive", "84", "84 x 84 x 5", 8.0, 60, METADRIVE)),
    )


def metadrive_192(plan: Plan) -> tuple[Row, ...]:
    """Compare with MetaDrive's top-down view of 192 x 192 x 5."""
    return (
        compare(
            plan, Rival("MetaDrive 192", "metadrive", "192", "192 x 192 x 5", 20.0, 30, METADRIVE)
        ),
    )


def car_racing(plan: Plan) -> tuple[Row, ...]:
    """Compare with Gymnasium's CarRacing."""
    note = "50 steps a second, flat physics in Box2D, one grassy track, no lights"
    return (compare(plan, Rival("CarRacing", "car_racing", "-", "96 x 96 x 3", 8.0, 40, note)),)


def intersection(plan: Plan) -> tuple[Row, ...]:
    """Compare with highway-env's intersection in grey, 192 x 192 with a stack of five."""
    note = "10 steps a second as ours, kinematic cars, ten or more of them, no lights"
    return (
        compare(
            plan,
            Rival("highway-env intersection", "highway", "192", "192 x 192 x 5", 20.0, 130, note),
        ),
    )


def compare(plan: Plan, rival: Rival) -> Row:
    """Step both in turns, each in a process of its own on the same core.

    Args:
        plan: How much to measure, and where the environments are.
        rival: With whom.
    """
    work = "one control step with its observation, on one core"
    python = interpreter(plan.rivals or CHECKOUT / ".rivals", rival.environment)
    world = WORLDS / f"{rival.environment}.py"
    if not world.exists():
        reason = "The rivals' side lies in scripts/bench of a checkout, and this is an installed package."
        return NotMeasured(rival.name, work, reason, f"in a checkout of mjdrive: {INSTALL}")
    if not python.exists():
        return NotMeasured(
            rival.name, work, f"There is no environment {python.parents[1]}.", INSTALL
        )
    ours = Path(str(importlib.resources.files("mjdrive.benchmarks") / "our_world.py"))
    log = plan.workspace / f"{rival.environment}.log"
    with (
        serve("mjdrive", Path(sys.executable), ours, ROUTE, log=plan.workspace / "ours.log") as us,
        serve(rival.name, python, world, rival.argument, log=log) as them,
    ):
        num_rounds = plan.rounds(11)
        pair = in_turns(us, them, our_steps=300, their_steps=rival.num_steps, rounds=num_rounds)
        versions = ", ".join(f"{name} {it}" for name, it in them.facts["versions"].items())
    return Comparison(
        name=rival.name,
        work=work,
        ours=OURS,
        theirs=f"{versions}, {rival.view}",
        our_rounds=pair.ours,
        their_rounds=pair.theirs,
        bar=rival.bar,
        piece="step",
        note=f"{rival.note}. Processor time of one thread.",
    )


def in_turns(us: Served, them: Served, *, our_steps: int, their_steps: int, rounds: int) -> Pair:
    """Step two worlds A B A B; the first round of each warms up and does not count.

    Args:
        us: Our world.
        them: The other one.
        our_steps: Steps a round of ours [-].
        their_steps: Steps a round of theirs [-].
        rounds: Rounds that count [-].

    Returns:
        Processor time of a step in each round [s].
    """
    taken = [
        (us.steps(our_steps) / our_steps, them.steps(their_steps) / their_steps)
        for _ in range(rounds + 1)
    ]
    ours, theirs = zip(*taken[1:], strict=True)
    return Pair(ours, theirs)


def interpreter(rivals: Path, environment: str) -> Path:
    """Where the Python of an environment lies, if it is there."""
    folder, file = ("Scripts", "python.exe") if os.name == "nt" else ("bin", "python")
    return rivals / environment / folder / file
