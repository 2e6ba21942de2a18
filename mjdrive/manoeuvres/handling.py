"""All manoeuvres on the plane, once: what the figures show and what must not depend on the timestep."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from mjdrive.manoeuvres import (
    acceleration,
    braking,
    standstill,
    steady_circle,
    step_steer,
    turning_circle,
)
from mjdrive.manoeuvres.bars import Bar
from mjdrive.manoeuvres.recording import Recording
from mjdrive.manoeuvres.rig import TIMESTEP, Rig


@dataclass(frozen=True, slots=True, eq=False)
class Handling:
    """The manoeuvres of one car.

    Attributes:
        acceleration: From rest to 100 km/h.
        stops: From each speed.
        circles: At each speed.
        step: At 80 km/h.
        standstills: On each slope.
        turning_circle: At full lock.
    """

    acceleration: Recording
    stops: tuple[braking.Stop, ...]
    circles: tuple[steady_circle.Circle, ...]
    step: step_steer.Step
    standstills: tuple[standstill.Standstill, ...]
    turning_circle: turning_circle.TurningCircle

    def bars(self) -> tuple[Bar, ...]:
        """Hold every figure against its limits."""
        return (
            *acceleration.bars(self.acceleration),
            *(bar for stop in self.stops for bar in braking.bars(stop)),
            *(bar for circle in self.circles for bar in steady_circle.bars(circle)),
            *step_steer.bars(self.step),
            *(bar for rest in self.standstills for bar in standstill.bars(rest)),
            *turning_circle.bars(self.turning_circle),
        )

    def figures(self) -> Mapping[str, tuple[float, float]]:
        """Figures that must not depend on the timestep: value, and the size that its change is compared with.

        Both have the same unit. The size is the value itself, but 100 % for an overshoot and the bar for creep: both
        are close to zero.
        """
        figures = {"0 to 100 km/h": acceleration.time_to_target(self.acceleration)}
        figures |= {f"stop from {stop.speed_kmh} km/h": stop.distance for stop in self.stops}
        for circle in self.circles:
            figures[f"understeer at {circle.speed_kmh} km/h"] = circle.understeer_gradient
            figures[f"limit at {circle.speed_kmh} km/h"] = circle.limit
        figures["yaw-rate gain"] = self.step.gain
        figures["time to 90 %"] = self.step.rise_time
        figures["turning radius"] = self.turning_circle.radius
        compared = {name: (value, abs(value)) for name, value in figures.items()}
        compared["overshoot"] = (self.step.overshoot, 100.0)
        for rest in self.standstills:
            most = standstill.MOST_CREEP_MM[rest.slope]
            compared[f"creep on {100 * rest.slope:.0f} %"] = (rest.creep_mm, most)
        return compared


NUM_MANOEUVRES = (
    3 + len(braking.SPEEDS_KMH) + len(steady_circle.SPEEDS_KMH) + len(standstill.MOST_CREEP_MM)
)
"""In a `Handling` [-]."""

_Manoeuvre = TypeVar("_Manoeuvre")


def measure(
    car: Path | None = None,
    *,
    timestep: float = TIMESTEP,
    on_manoeuvre: Callable[[], None] = lambda: None,
) -> Handling:
    """Drive all manoeuvres on the plane.

    Args:
        car: MJCF; the default car if None.
        timestep: Of the physics [s].
        on_manoeuvre: Called after each.

    Returns:
        The recordings.
    """

    def rig(slope: float = 0.0) -> Rig:
        return Rig.of_car(car, timestep=timestep, slope=slope)

    def done(manoeuvre: _Manoeuvre) -> _Manoeuvre:
        on_manoeuvre()
        return manoeuvre

    return Handling(
        acceleration=done(acceleration.accelerate(rig())),
        stops=tuple(done(braking.brake(rig(), speed)) for speed in braking.SPEEDS_KMH),
        circles=tuple(
            done(steady_circle.circle(rig(), speed)) for speed in steady_circle.SPEEDS_KMH
        ),
        step=done(step_steer.step(rig())),
        standstills=tuple(
            done(standstill.stand(rig(slope), slope)) for slope in standstill.MOST_CREEP_MM
        ),
        turning_circle=done(turning_circle.turn(rig())),
    )
