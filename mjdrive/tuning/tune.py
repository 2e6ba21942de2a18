"""Tune an expert to a car: search on one town, check on another, write both down."""

from collections.abc import Callable
from dataclasses import dataclass

from mjdrive import versions
from mjdrive.config import TuneConfig
from mjdrive.datatypes import Town
from mjdrive.expert.experts import make_expert
from mjdrive.simulation.simulation import Simulation
from mjdrive.tuning import course, search
from mjdrive.tuning.gains import Evidence, Gains, plain
from mjdrive.tuning.knobs import ExpertConfig, knobs
from mjdrive.tuning.marks import Marks, judge
from mjdrive.tuning.search import Tried
from mjdrive.vehicle.cars import CarModel


@dataclass(frozen=True, slots=True, eq=False)
class Tuning:
    """What tuning found.

    Attributes:
        gains: The best settings and their evidence.
        tried: All trials in their order.
        before: The exercises of the check, or of the town tuned on, as the settings at the start drove them.
        after: The same as the tuned settings drove them.
    """

    gains: Gains
    tried: tuple[Tried, ...]
    before: tuple[course.Trace, ...]
    after: tuple[course.Trace, ...]


class Judge:
    """Drives the course of one town with any settings of an expert.

    Args:
        town: Where.
        car: Which car.
        expert: Name of the expert.
        config: Which exercises, and what their marks cost.

    Raises:
        RouteError: If the town has no way through a junction.
    """

    def __init__(self, town: Town, car: CarModel, expert: str, config: TuneConfig) -> None:
        self.town = town
        self.exercises = course.course(town, bends=config.bends)
        self._simulation = Simulation(town, car=car)
        self._expert = expert
        self._config = config

    def traces(self, settings: ExpertConfig) -> tuple[course.Trace, ...]:
        """Drive every exercise."""
        expert = make_expert(
            self._expert,
            self.town,
            parameters=self._simulation.car.parameters,
            settings=settings,
            control_interval=self._simulation.config.control_interval,
        )
        return tuple(course.drive(self._simulation, one, expert) for one in self.exercises)

    def __call__(self, settings: ExpertConfig) -> Marks:
        """Drive the course and mark it."""
        return judge(self.traces(settings), self._config)


def tune(
    expert: str,
    start: ExpertConfig,
    *,
    car: CarModel,
    town: Town,
    check_town: Town | None,
    config: TuneConfig,
    seed: int,
    on_trial: Callable[[Tried], None] = lambda tried: None,
) -> Tuning:
    """Find the settings with which an expert drives a car best.

    Args:
        expert: Name of the expert.
        start: Settings to begin with.
        car: The car.
        town: Where settings are tried.
        check_town: Where only the first and the best are driven, or None for nowhere.
        config: How many trials, and what good driving is.
        seed: The same seed gives the same settings.
        on_trial: Told of each trial.

    Raises:
        RouteError: If a town has no way through a junction.
        UnknownNameError: If there is no such expert.
    """
    chosen = knobs(expert)
    on_town = Judge(town, car, expert, config)
    on_check = Judge(check_town, car, expert, config) if check_town is not None else None
    tried = search.search(start, chosen, on_town, config=config, seed=seed, on_trial=on_trial)
    best = search.best(tried)
    last = on_check or on_town
    before, after = last.traces(start), last.traces(best.settings)
    checked = None
    if on_check is not None:
        marks = judge(before, config), judge(after, config)
        checked = Evidence(on_check.town.name, on_check.town.digest, *marks)
    gains = Gains(
        expert=expert,
        car=car.name,
        car_digest=car.digest,
        settings=plain(best.settings),
        tuned=tuple(dict.fromkeys(knob.field for knob in chosen)),
        tuned_on=Evidence(town.name, town.digest, tried[0].marks, best.marks),
        checked_on=checked,
        trials=len(tried),
        seed=seed,
        search=plain(config),
        versions=versions.versions(),
    )
    return Tuning(gains, tried, before, after)
