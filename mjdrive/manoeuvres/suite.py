"""All manoeuvres of `mjdrive car test`, and the report that they leave behind."""

import dataclasses
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from mjdrive import versions
from mjdrive.files import write_atomically
from mjdrive.manoeuvres import (
    convergence,
    cost,
    determinism,
    handling,
    own_bars,
    ramming,
    random_driving,
    town_moves,
)
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.handling import Handling
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library
from mjdrive.vehicle.cars import CarModel

FORMAT = "mjdrive-car-test-1"

Track = Callable[[str, int], Callable[[], None]]
"""Told what begins and of how many parts it is; what it returns is called after each part."""


@dataclass(frozen=True, slots=True)
class Plan:
    """How much is driven.

    Attributes:
        num_seeds: Of random driving [-].
        random_duration: Of each of them [s].
        rams_per_kind: Obstacles of each kind that are rammed [-].
        digest_duration: Of the drives whose bytes are compared [s].
    """

    num_seeds: int = random_driving.NUM_SEEDS
    random_duration: float = random_driving.DURATION
    rams_per_kind: int = ramming.PER_KIND
    digest_duration: float = determinism.DURATION


QUICK = Plan(num_seeds=3, random_duration=50.0, rams_per_kind=2, digest_duration=15.0)


@dataclass(frozen=True, slots=True, eq=False)
class Report:
    """What a car can do.

    Attributes:
        car: The car.
        handling: Its manoeuvres on the plane.
        bars: Every figure and its limits.
    """

    car: CarModel
    handling: Handling
    bars: tuple[Bar, ...]


def run(car: CarModel, plan: Plan, track: Track = lambda _name, _count: lambda: None) -> Report:
    """Drive everything.

    Args:
        car: Which car.
        plan: How much.
        track: Told how far it has come.
    """
    path = car.path
    driven = handling.measure(
        path, on_manoeuvre=track("manoeuvres on the plane", handling.NUM_MANOEUVRES)
    )
    bars = list(driven.bars())
    finer = len(convergence.DIVISORS) * handling.NUM_MANOEUVRES
    bars += convergence.bars(driven, path, track("the same, smaller timesteps", finer))
    bars += _moves(car, track)
    bars += _rams(car, plan, track)
    bars += _random(car, plan, track)
    compared = track("same seed, same bytes", 1)
    bars += determinism.bars(path, plan.digest_duration)
    compared()
    rounds = track("cost in a full town", cost.NUM_ROUNDS)
    bars += cost.bars(cost.measure(library.load(cost.TOWN), car=car, on_round=rounds))
    return Report(car, driven, own_bars.of_car(bars, car))


def _moves(car: CarModel, track: Track) -> tuple[Bar, ...]:
    town = library.load(town_moves.TOWN)
    names = town_moves.moves(town)
    done = track(f"moves of {town.name}", len(names))
    return town_moves.bars(town_moves.drive_moves(Simulation(town, car=car), names, done))


def _rams(car: CarModel, plan: Plan, track: Track) -> tuple[Bar, ...]:
    ground = ramming.RammingGround(library.load(town_moves.TOWN), car)
    done = track("ramming", ground.count(plan.rams_per_kind))
    return ramming.bars(ramming.ram_all(ground, per_kind=plan.rams_per_kind, on_ram=done))


def _random(car: CarModel, plan: Plan, track: Track) -> tuple[Bar, ...]:
    total = plan.random_duration + random_driving.STOPPING_TIME
    second = track("random actions", round(plan.num_seeds * total))
    drives = [
        random_driving.drive_randomly(
            seed, car=car.path, duration=plan.random_duration, on_second=second
        )
        for seed in range(plan.num_seeds)
    ]
    return random_driving.bars(drives, plan.random_duration)


def write_report(report: Report, path: Path) -> None:
    """Write car, versions and every bar as JSON.

    Args:
        report: What was measured.
        path: File to write.
    """
    rows = []
    for bar in report.bars:
        measured = bar.measured if math.isfinite(bar.measured) else None
        rows.append({**dataclasses.asdict(bar), "measured": measured, "holds": bar.holds})
    content = {
        "format": FORMAT,
        "car": report.car.name,
        "car_digest": report.car.digest,
        "parameters": dataclasses.asdict(report.car.parameters),
        "versions": versions.versions(),
        "bars": rows,
    }
    write_atomically(path, (json.dumps(content, indent=2) + "\n").encode())
