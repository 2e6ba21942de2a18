"""Let experts drive every route of some towns under many light seeds, and say whether each drive was flawless.

A drive is flawless with no infraction, no time off the road, no stop line passed on red or on a yellow that left room to
stop, and every start within a second of green. Exit status 1 if any is not.

Example: python scripts/check_experts.py --expert pid --expert mpc --seeds 10 --jobs 2 --out drives/experts.json
"""

import dataclasses
import json
import statistics
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import click
import numpy as np

from mjdrive.cli.console import progress_bars
from mjdrive.cli.main import Script
from mjdrive.cli.options import Jobs, chosen_executor, executor_options
from mjdrive.cli.solving import solve_rows
from mjdrive.config import CollectConfig
from mjdrive.datatypes import Policy, Situation
from mjdrive.episodes.collection import collect_route, expert_of
from mjdrive.episodes.plan import lay_routes
from mjdrive.errors import RouteError
from mjdrive.evaluation import lane_keeping
from mjdrive.evaluation.light_behaviour import is_rash, light_passages
from mjdrive.execution.work import Tell
from mjdrive.expert import experts
from mjdrive.expert.solves import SOLVER, SOLVES
from mjdrive.files import write_atomically
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle import cars

LATEST_START = 1.0
"""A car that waited moves within this time of green [s]."""


@dataclasses.dataclass(frozen=True)
class Job:
    """Expert, car, town, route and light seed of one drive."""

    expert: str
    car: str
    town: str
    route: str
    seed: int

    @property
    def name(self) -> str:
        """All of it in words."""
        return f"{self.expert} {self.car} {self.town} {self.route} seed {self.seed}"


class Checking:
    """What a process has to know to check drives: nothing."""

    def begin(self) -> Callable[[Job, Tell], "Drive"]:
        """Nothing to prepare: a simulation is made when the first job asks for it."""
        return Checker()


@dataclasses.dataclass(frozen=True)
class Drive:
    """What one drive was like: its job, and the figures that decide; empty reason: it was flawless."""

    expert: str
    town: str
    route: str
    seed: int
    steps: int
    off_road_s: float
    infractions: tuple[str, ...]
    rash_lights: tuple[str, ...]
    slowest_start_s: float
    offset_rms_m: float
    solver: str = ""
    solves: dict[str, int] = dataclasses.field(default_factory=dict)
    reason: str = ""

    @property
    def flaw(self) -> str:
        """What was wrong with it, in words."""
        flaws = [self.reason] if self.reason else []
        flaws += [f"infraction {name}" for name in self.infractions]
        flaws += [f"rash at light {name}" for name in self.rash_lights]
        if self.off_road_s > 0:
            flaws.append(f"{self.off_road_s:.1f} s off road")
        if self.slowest_start_s > LATEST_START:
            flaws.append(f"start {self.slowest_start_s:.1f} s after green")
        return ", ".join(flaws)


class Checker:
    """Checks drives; simulation and expert of the last one are kept for the next.

    They are kept in here and not in a cache of this module, which clusters would look for where it is not.
    """

    def __init__(self) -> None:
        self._made_for: tuple[str, str, str] | None = None

    def __call__(self, job: Job, tell: Tell) -> Drive:
        """Check the drive of a job."""
        wanted = (job.expert, job.car, job.town)
        if wanted != self._made_for:
            self._simulation = Simulation(library.load(job.town), car=cars.load(job.car))
            settings = CollectConfig(expert=experts.known(job.expert))
            self._expert = expert_of(settings, self._simulation)
            self._made_for = wanted
        return drive(job, self._simulation, self._expert)


def drive(job: Job, simulation: Simulation, expert: Policy[Situation]) -> Drive:
    """Drive one route with one light seed, undisturbed, and look at it."""
    expert_name, town_name, route_name, seed = job.expert, job.town, job.route, job.seed
    town = simulation.town
    settings = CollectConfig(
        routes=(route_name,), disturbance=None, expert=experts.known(expert_name)
    )
    waypoints = library.load_settings(town_name).routes
    route = lay_routes(town, waypoints, settings=settings)[route_name]
    try:
        episode = collect_route(simulation, route, config=settings, seed=seed, expert=expert)
    except RouteError as error:
        return Drive(
            expert_name, town_name, route_name, seed, 0, 0.0, (), (), 0.0, 0.0, reason=str(error)
        )
    car_size = simulation.car.parameters
    passages = light_passages(
        episode, town, route, nose_ahead=car_size.length - car_size.rear_overhang
    )
    late = settings.pid.late_braking
    keeping = lane_keeping.summarise(episode, lane_keeping.track(episode, town))
    return Drive(
        expert=expert_name,
        town=town_name,
        route=route_name,
        seed=seed,
        steps=len(episode.time),
        off_road_s=simulation.config.control_interval * int(np.count_nonzero(~episode.on_lane)),
        infractions=tuple(f"{it.kind.name.lower()} ({it.cause})" for it in episode.infractions),
        rash_lights=tuple(it.light for it in passages if is_rash(it, late_braking=late)),
        slowest_start_s=max((it.start_delay or 0.0 for it in passages), default=0.0),
        offset_rms_m=keeping.offset_rms_m or 0.0,
        solver=episode.metadata.get(SOLVER, ""),
        solves=json.loads(episode.metadata.get(SOLVES, "{}")),
    )


def row(name: str, town: str, drives: Sequence[Drive]) -> str:
    """One line of the table, in Markdown: the routes of a town are one lap under each seed."""
    seeds = sorted({it.seed for it in drives})
    laps = [0.1 * sum(it.steps for it in drives if it.seed == seed) for seed in seeds]
    spread = statistics.stdev(laps) if len(laps) > 1 else 0.0
    cells = (
        name,
        town,
        f"{sum(not it.flaw for it in drives)} of {len(drives)}",
        sum(len(it.infractions) for it in drives),
        f"{sum(it.off_road_s for it in drives):.1f}",
        sum(len(it.rash_lights) for it in drives),
        f"{max(it.slowest_start_s for it in drives):.1f}",
        f"{statistics.mean(laps):,.0f} ± {spread:.0f}",
        f"{np.sqrt(np.mean([it.offset_rms_m**2 for it in drives])):.2f}",
        solves(drives),
    )
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def solves(drives: Sequence[Drive]) -> str:
    """Solver and what became of its solves, in the words of the closing tables; a dash if nothing was solved."""
    told = solve_rows((it.solver for it in drives), (it.solves for it in drives))
    return "; ".join(told.values()) or "-"


@click.command(cls=Script)
@click.option("--expert", "names", multiple=True, default=("pid",), show_default=True)
@click.option("--town", "towns", multiple=True, default=("town01", "town02"), show_default=True)
@click.option("--car", default="default", show_default=True)
@click.option("--seeds", "num_seeds", default=10, show_default=True, help="Light seeds 0, 1, ...")
@executor_options
@click.option("--out", type=click.Path(path_type=Path), help="JSON file for every drive.")
def main(
    *,
    names: tuple[str, ...],
    towns: tuple[str, ...],
    car: str,
    num_seeds: int,
    jobs: Jobs,
    backend: str,
    address: str | None,
    out: Path | None,
) -> None:
    """Drive every route under every seed and print a table."""
    plan = [
        Job(experts.known(name), car, town, route, seed)
        for name in names
        for town in towns
        for route in library.load_settings(town).routes
        for seed in range(num_seeds)
    ]
    executor = chosen_executor(jobs, backend, address)
    found: dict[Job, Drive] = {}
    with progress_bars() as bars:
        task = bars.add_task("experts", total=len(plan), unit="drives")
        for job, done in executor.run(Checking(), plan, on_progress=lambda job, steps: None):
            found[job] = done
            bars.advance(task)
    drives = [found[job] for job in plan]
    print(
        "| expert | town | flawless | infractions | off road [s] | rash | slowest start [s] ",
        end="",
    )
    print("| all routes [s] | lane offset RMS [m] | solves |")
    print(f"|{'---|' * 10}")
    for name in names:
        for town in towns:
            print(row(name, town, [it for it in drives if (it.expert, it.town) == (name, town)]))
    for it in drives:
        if it.flaw:
            print(f"{it.expert} {it.town} {it.route} seed {it.seed}: {it.flaw}")
    if out is not None:
        content = json.dumps(
            [{**dataclasses.asdict(it), "flaw": it.flaw} for it in drives], indent=1
        )
        write_atomically(out, (content + "\n").encode())
    sys.exit(any(it.flaw for it in drives))


if __name__ == "__main__":
    main()
