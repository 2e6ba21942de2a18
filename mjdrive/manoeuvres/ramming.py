"""Driving into everything that stands in a town, at 50 km/h: no tunnelling, no energy gained, and then rest."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from mjdrive.datatypes import Action, Town
from mjdrive.manoeuvres.barriers import with_barriers
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.energy import EnergyMeter, GainWatch
from mjdrive.manoeuvres.random_driving import upright
from mjdrive.simulation.simulation import Simulation
from mjdrive.vehicle import engine
from mjdrive.vehicle.cars import CarModel

KINDS = ("building", "pole", "tree", "sign", "object", "kerb")
"""First word of the names of geoms that the car can hit."""

SPEED = 50 / 3.6  # [m/s]
PER_KIND = 8
GAP = 3.0  # between nose and obstacle at the start [m]
NUM_HEADINGS = 16
RAM_TIME = 1.0  # rolling into it, pedals free [s]
BRAKE_TIME = 8.0  # then [s]
MOST_DEPTH = 0.3  # of hull or tyre in an obstacle; a crumple zone is longer [m]
MOST_GAIN = 0.1  # of energy, over the kinetic energy of the approach [%]
STANDS = 0.05  # [m/s]
MOST_LEAN = 15.0  # of a car that stands, two wheels on a kerb or not [deg]
LEAST_HEIGHT = (
    -0.05
)  # of its rear axle above where it is on unloaded tyres; lower it has sunk in [m]


class Ram(NamedTuple):
    """One obstacle, rammed.

    Attributes:
        obstacle: Name of its geom.
        depth: How far hull or tyre went into it [m].
        gain: Largest rise of the energy, before, in and after the impact, over the kinetic energy of the approach [%];
            see `energy.GainWatch`.
        final_speed: After the car has been braked [m/s].
        final_lean: In any direction, then [deg].
        final_height: Of its rear axle, then, above where it is on unloaded tyres [m].
        num_warnings: That MuJoCo gave [-].
        is_finite: Whether all numbers were finite to the end.
    """

    obstacle: str
    depth: float
    gain: float
    final_speed: float
    final_lean: float
    final_height: float
    num_warnings: int
    is_finite: bool

    @property
    def stands(self) -> bool:
        """Whether the car has come to rest on its wheels, on the road or above; never if a figure is no number."""
        figures = (self.depth, self.gain, self.final_speed, self.final_lean, self.final_height)
        return (
            self.is_finite
            and all(math.isfinite(figure) for figure in figures)
            and self.final_speed <= STANDS
            and self.final_lean <= MOST_LEAN
            and self.final_height >= LEAST_HEIGHT
        )


class RammingGround:
    """A town with barriers, and a car to drive into things.

    Args:
        town: Where; barriers are added.
        car: Which car; the default one if None.
    """

    def __init__(self, town: Town, car: CarModel | None = None) -> None:
        simulation = Simulation(with_barriers(town, PER_KIND), car=car)
        self._model, self._data, self._car = simulation.model, simulation.data, simulation.car
        self._meter = EnergyMeter(self._model, self._data, self._car)
        update_interval = simulation.config.car_update_interval
        self._steps_per_update = round(update_interval / self._model.opt.timestep)
        self._parts = self._car.hull_geoms | self._car.tyre_geoms

    def obstacles(self, kind: str, number: int) -> list[str]:
        """Names of obstacles of a kind, spread over all there are.

        Args:
            kind: One of `KINDS`.
            number: How many at most [-].
        """
        names = [self._model.geom(index).name for index in range(self._model.ngeom)]
        found = [name for name in names if name.split("_")[0] == kind]
        return found[:: max(len(found) // number, 1)][:number]

    def count(self, per_kind: int) -> int:
        """How many obstacles `ram_all` takes on.

        Args:
            per_kind: How many of each kind at most [-].
        """
        return sum(len(self.obstacles(kind, per_kind)) for kind in KINDS)

    def ram(self, obstacle: str) -> Ram | None:
        """Drive into an obstacle from wherever the way to it is free.

        Args:
            obstacle: Name of its geom.

        Returns:
            What happened, or None if nothing can get at it.
        """
        for heading in np.linspace(0.0, 2.0 * math.pi, NUM_HEADINGS, endpoint=False):
            if self._approach(obstacle, float(heading)):
                ram = self._drive_into(obstacle)
                if ram is not None:
                    return ram
        return None

    def _approach(self, obstacle: str, heading: float) -> bool:
        """Place the car before an obstacle; tell whether it stands on the road alone."""
        geom = self._model.geom(obstacle).id
        target = self._model.geom_pos[geom, :2]  # all that stands belongs to the world
        parameters = self._car.parameters
        nose = parameters.length - parameters.rear_overhang
        ahead = np.array([math.cos(heading), math.sin(heading)])
        reach = self._extent(geom, ahead)
        x, y = target - (reach + GAP + nose) * ahead
        self._car.place(float(x), float(y), heading, speed=SPEED)
        road = self._model.geom("road").id
        return bool((self._data.contact.geom == road).any(axis=1).all())

    def _extent(self, geom: int, ahead: np.ndarray) -> float:
        """From the middle of a geom to its edge in a direction on the ground [m]."""
        box = self._model.geom_aabb[geom]
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, self._model.geom_quat[geom])
        return float(np.abs(ahead @ rotation.reshape(3, 3)[:2]) @ box[3:])

    def _drive_into(self, obstacle: str) -> Ram | None:
        geom, data = self._model.geom(obstacle).id, self._data
        warnings_before = engine.num_warnings(data)
        watch, depth = GainWatch(), 0.0
        watch.note(self._meter.read(), is_complete=self._meter.is_complete)
        num_updates = round((RAM_TIME + BRAKE_TIME) / self._model.opt.timestep)
        has_hit = False
        for number in range(num_updates):
            if number % self._steps_per_update == 0:
                braking = data.time >= RAM_TIME
                self._car.command(Action(-1.0 if braking else 0.0, 0.0))
                self._car.update()
            mujoco.mj_step(self._model, data)
            watch.note(self._meter.read(), is_complete=self._meter.is_complete)
            touched, deepest = self._touch(geom)
            has_hit |= touched
            depth = max(depth, deepest)
            if not has_hit and data.time > RAM_TIME:
                return None
        return Ram(
            obstacle=obstacle,
            depth=depth,
            gain=100.0 * watch.largest / (0.5 * self._car.parameters.mass * SPEED**2),
            final_speed=float(np.hypot(*data.qvel[:2])),
            final_lean=float(np.degrees(np.arccos(np.clip(upright(data), -1.0, 1.0)))),
            final_height=float(data.qpos[2]),
            num_warnings=engine.num_warnings(data) - warnings_before,
            is_finite=bool(np.isfinite(data.qpos).all()),
        )

    def _touch(self, obstacle: int) -> tuple[bool, float]:
        """Whether the car touches an obstacle, and how deep it is in it [m]."""
        contact = self._data.contact
        of_it = (contact.geom == obstacle).any(axis=1)
        if not of_it.any():
            return False, 0.0
        return True, float(max(-contact.dist[of_it].min(), 0.0))


def ram_all(
    ground: RammingGround,
    kinds: Sequence[str] = KINDS,
    *,
    per_kind: int = PER_KIND,
    on_ram: Callable[[], None] = lambda: None,
) -> dict[str, list[Ram]]:
    """Ram some obstacles of each kind.

    Args:
        ground: Where.
        kinds: Which.
        per_kind: How many of each [-].
        on_ram: Called after each.

    Returns:
        What happened, by kind.
    """
    rams: dict[str, list[Ram]] = {kind: [] for kind in kinds}
    for kind in kinds:
        for obstacle in ground.obstacles(kind, per_kind):
            ram = ground.ram(obstacle)
            if ram is not None:
                rams[kind].append(ram)
            on_ram()
    return rams


def bars(rams: Mapping[str, Sequence[Ram]]) -> tuple[Bar, ...]:
    """Hold the worst of each kind of obstacle, and the worst of all, against the limits."""
    name = f"ramming at {3.6 * SPEED:.0f} km/h"
    found = [
        Bar(
            name,
            f"depth in {kind}, deepest of {len(of_kind)}",
            max((ram.depth for ram in of_kind), default=math.nan),
            "m",
            most=MOST_DEPTH,
            reason="no tunnelling",
        )
        for kind, of_kind in rams.items()
    ]
    if "kerb" in rams:
        fallen = float(sum(not ram.stands for ram in rams["kerb"]))
        reason = "driven over or onto: upright, not sunk in, at rest"
        found.append(Bar(name, "kerbs that are the end", fallen, "kerbs", most=0.0, reason=reason))
    every = [ram for of_kind in rams.values() for ram in of_kind]
    broken = float(sum(not ram.is_finite for ram in every))
    warnings = float(sum(ram.num_warnings for ram in every))
    gain = max((ram.gain for ram in every), default=math.nan)
    final = max((ram.final_speed for ram in every), default=math.nan)
    return (
        *found,
        Bar(name, "impacts that end in no number", broken, "impacts", most=0.0),
        Bar(name, "warnings of MuJoCo", warnings, "warnings", most=0.0),
        Bar(name, "energy gained", gain, "%", most=MOST_GAIN, reason="of the kinetic energy"),
        Bar(name, "speed after braking", final, "m/s", most=STANDS, reason="comes to rest"),
    )
