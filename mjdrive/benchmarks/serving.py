"""Steps an environment when it is told to, in a process of its own: ours and the rivals' all run behind this program.

It needs nothing but Python, because every rival has an environment of its own. `python serving.py WORLD.py ARGUMENT`
runs `make(ARGUMENT)` of the file WORLD.py, which returns a world: an object with a method `step()`, which does one
control step with its observation and starts again where it has to, and a mapping `facts`. It prints the facts as one line
of JSON; then, for each line `{"steps": N}` that it reads, one with the processor time and the wall time that they took
and the number of fresh starts among them. It ends with its input.
"""

import contextlib
import json
import os
import runpy
import sys
import time
from collections.abc import Mapping
from typing import Protocol


class World(Protocol):
    """What can be stepped.

    Attributes:
        facts: Versions, shape of the observation and what else describes the work.
        num_resets: Fresh starts so far [-].
        deciding: Processor time that steps spent so far on deciding what to do, which is nobody's work here [s].
    """

    facts: Mapping[str, object]
    num_resets: int
    deciding: float

    def step(self) -> None:
        """Do one control step, observation included."""


def use_one_core() -> None:
    """Stay on one core, where the system can promise that; threads beyond the first would only wait there."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def timed_steps(world: World, num_steps: int) -> dict[str, float]:
    """Step a world by the clock.

    Args:
        world: What to step.
        num_steps: How often [-].

    Returns:
        Processor time of all steps together, without deciding what to do, their wall time with it [s], and fresh starts
        among them [-].
    """
    resets, deciding = world.num_resets, world.deciding
    wall, processor = time.perf_counter(), time.process_time()
    for _ in range(num_steps):
        world.step()
    return {
        "cpu": time.process_time() - processor - (world.deciding - deciding),
        "wall": time.perf_counter() - wall,
        "resets": world.num_resets - resets,
    }


def main() -> None:
    """Make a world and step it as told."""
    use_one_core()
    path, argument = sys.argv[1:]
    with contextlib.redirect_stdout(
        sys.stderr
    ):  # rivals print; our lines are for the other process
        world = runpy.run_path(path)["make"](argument)
    print(json.dumps(dict(world.facts)), flush=True)  # noqa: T201  (that is the protocol)
    for line in sys.stdin:
        with contextlib.redirect_stdout(sys.stderr):
            answer = timed_steps(world, json.loads(line)["steps"])
        print(json.dumps(answer), flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
