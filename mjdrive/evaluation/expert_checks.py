"""Drives a route as an expert does, and looks at it closely."""

import dataclasses
import json
import time
from collections.abc import Callable

import numpy as np

from mjdrive.config import CollectConfig
from mjdrive.datatypes import Action, Policy, Situation
from mjdrive.episodes.collection import collect_route, expert_of
from mjdrive.episodes.plan import lay_routes
from mjdrive.errors import RouteError
from mjdrive.evaluation import lane_keeping
from mjdrive.evaluation.comfort import comfort
from mjdrive.evaluation.expert_drives import Drive, Job, Times, rounded
from mjdrive.evaluation.light_behaviour import is_rash, light_passages
from mjdrive.execution.work import Tell
from mjdrive.expert import experts
from mjdrive.expert.solves import SOLVER, SOLVES, SolveWatch
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle import cars


class WatchedExpert:
    """An expert that is looked at while it drives: how long it takes to decide, and how far it is from its route.

    Args:
        expert: Who drives.

    Attributes:
        wall: Time that each decision took by the clock [s].
        cpu: CPU time that it took [s].
        offset: Distance from the route at each decision, positive to the left [m].
    """

    def __init__(self, expert: Policy[Situation]) -> None:
        self._expert = expert
        self.name = expert.name
        self.wall: list[float] = []
        self.cpu: list[float] = []
        self.offset: list[float] = []

    def reset(self, seed: int) -> None:
        """Begin a drive."""
        self._expert.reset(seed)

    def act(self, view: Situation) -> Action:
        """Let the expert decide."""
        wall, cpu = time.perf_counter(), time.thread_time()
        action = self._expert.act(view)
        self.cpu.append(time.thread_time() - cpu)
        self.wall.append(time.perf_counter() - wall)
        self.offset.append(view.offset)
        return action


class Checking:
    """What a process has to know to check drives: nothing."""

    def begin(self) -> Callable[[Job, Tell], Drive]:
        """Nothing to prepare: a simulation is made when the first job asks for it."""
        return Checker()


class Checker:
    """Checks drives; simulations and experts are kept for the next.

    They are kept in here and not in a cache of this module, which clusters would look for where it is not.
    """

    def __init__(self) -> None:
        self._simulations: dict[tuple[str, str], Simulation] = {}
        self._experts: dict[tuple[str, str, str], Policy[Situation]] = {}

    def __call__(self, job: Job, tell: Tell) -> Drive:
        """Check the drive of a job."""
        place, who = (job.town, job.car), (job.town, job.car, job.expert)
        if place not in self._simulations:
            self._simulations[place] = Simulation(library.load(job.town), car=cars.load(job.car))
        if who not in self._experts:
            settings = CollectConfig(expert=experts.known(job.expert))
            self._experts[who] = expert_of(settings, self._simulations[place])
        return drive(job, self._simulations[place], self._experts[who])


def drive(job: Job, simulation: Simulation, expert: Policy[Situation]) -> Drive:
    """Drive one route with one light seed, undisturbed, and look at it."""
    town = simulation.town
    settings = CollectConfig(
        routes=(job.route,), disturbance=None, expert=experts.known(job.expert)
    )
    waypoints = library.load_settings(job.town).routes
    route = lay_routes(town, waypoints, settings=settings)[job.route]
    watched, solves = WatchedExpert(expert), SolveWatch(expert)
    found = Drive(**dataclasses.asdict(job))
    try:
        episode = collect_route(simulation, route, config=settings, seed=job.seed, expert=watched)
    except RouteError as error:
        return dataclasses.replace(found, reason=str(error))
    car_size = simulation.car.parameters
    passages = light_passages(
        episode, town, route, nose_ahead=car_size.length - car_size.rear_overhang
    )
    late_braking = settings.pid.late_braking
    keeping = lane_keeping.summarise(episode, lane_keeping.track(episode, town))
    moves = np.abs(episode.vehicle[:, 3]) >= lane_keeping.MOVING_SPEED
    offset = np.abs(np.array(watched.offset))[moves]
    interval = simulation.config.control_interval
    smoothness = comfort(episode, interval=interval)
    metadata = solves.metadata()
    return dataclasses.replace(
        found,
        steps=len(episode.time),
        off_road_s=rounded(interval * np.count_nonzero(~episode.on_lane)),
        infractions=tuple(f"{it.kind.name.lower()} ({it.cause})" for it in episode.infractions),
        rash_lights=tuple(it.light for it in passages if is_rash(it, late_braking=late_braking)),
        slowest_start_s=rounded(max((it.start_delay or 0.0 for it in passages), default=0.0)),
        street_offset_rms_m=keeping.offset_rms_m or 0.0,
        offset_rms_m=rounded(np.sqrt(np.mean(offset**2))),
        offset_max_m=rounded(np.max(offset)),
        jerk_rms=rounded(smoothness.jerk_rms),
        steering_whiteness=rounded(smoothness.steering_whiteness),
        steering_unrest=rounded(smoothness.steering_unrest),
        wall=Times.of(np.array(watched.wall)),
        cpu=Times.of(np.array(watched.cpu)),
        late=solves.late,
        solver=metadata.get(SOLVER, ""),
        solves=json.loads(metadata.get(SOLVES, "{}")),
    )
