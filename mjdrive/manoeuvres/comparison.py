"""The car beside models of cars: the same manoeuvres, driven by the same code."""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mjdrive.files import write_atomically
from mjdrive.manoeuvres import bmw_320i, multi_body, steady_circle, step_steer
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL, Plant
from mjdrive.manoeuvres.rig import GRAVITY, Rig
from mjdrive.manoeuvres.single_track_cars import LinearCar, SingleTrackCar
from mjdrive.manoeuvres.steady_circle import Circle
from mjdrive.manoeuvres.step_steer import Step
from mjdrive.vehicle.cars import CarModel

SPEEDS_KMH = (30, 80)
ACCELERATIONS = (2.0, 4.0, 6.0, 8.0)
"""At which steering angles are compared [m/s2]."""

NUM_MANOEUVRES = len(SPEEDS_KMH) + 1
"""Of each car [-]."""

KINEMATIC, LINEAR, MULTI_BODY = "kinematic", "linear", "multi-body"
"""Single-track models, and CommonRoad's model."""


@dataclass(frozen=True, slots=True, eq=False)
class Behaviour:
    """How one car or model behaves.

    Attributes:
        circles: By speed [km/h].
        step: At 80 km/h.
        slides: Whether its tyres have a limit.
    """

    circles: Mapping[int, Circle]
    step: Step
    slides: bool

    def figures(self) -> dict[str, tuple[str, float]]:
        """What a table shows: unit and value by name; not a number where the model has no answer."""
        found: dict[str, tuple[str, float]] = {}
        to_deg_per_g = math.degrees(1.0) * GRAVITY
        for speed_kmh, circle in self.circles.items():
            for acceleration in ACCELERATIONS:
                name = f"{speed_kmh} km/h, steer at {acceleration:.0f} m/s2"
                found[name] = ("deg", math.degrees(steering_angle_at(circle, acceleration)))
            limit = circle.limit / GRAVITY if self.slides else math.nan
            found[f"{speed_kmh} km/h, limit"] = ("g", limit)
        fast = self.circles[80]
        found["80 km/h, understeer"] = ("deg/g", to_deg_per_g * fast.understeer_gradient)
        found["80 km/h, body slip"] = ("deg/g", to_deg_per_g * fast.body_slip_gradient)
        roll = to_deg_per_g * fast.roll_gradient if self.slides else math.nan
        found["80 km/h, roll"] = ("deg/g", roll)
        found["80 km/h, yaw-rate gain"] = ("1/s", self.step.gain)
        found["80 km/h, time to 90 %"] = ("s", self.step.rise_time)
        found["80 km/h, overshoot"] = ("%", self.step.overshoot)
        return found


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """One car beside the models of it.

    Attributes:
        title: Which car.
        behaviours: By the name of the car or model; the car itself is first.
    """

    title: str
    behaviours: Mapping[str, Behaviour]


def steering_angle_at(circle: Circle, acceleration: float) -> float:
    """Steering angle at which a lateral acceleration is reached first.

    Args:
        circle: Of rising lateral acceleration.
        acceleration: Lateral [m/s2].

    Returns:
        Angle [rad]; not a number if the car never gets there.
    """
    window = np.full(round(0.5 / UPDATE_INTERVAL), UPDATE_INTERVAL / 0.5)
    lateral = np.convolve(circle.recording.lateral_acceleration, window, "valid")
    angle = np.convolve(circle.recording.steering_angle, window, "valid")
    first = int(np.argmax(lateral >= acceleration))
    if lateral[first] < acceleration:
        return math.nan
    before = max(first - 1, 0)
    share = (acceleration - lateral[before]) / max(lateral[first] - lateral[before], 1e-9)
    return float(angle[before] + share * (angle[first] - angle[before]))


def compare(car: CarModel, on_manoeuvre: Callable[[], None] = lambda: None) -> Comparison:
    """Drive a car and the two single-track models of it.

    Args:
        car: Which car.
        on_manoeuvre: Called after each manoeuvre.
    """
    rig = Rig.of_car(car.path)
    plants = {car.name: rig, **_single_track_cars(rig)}
    return _drive_all(f"our car ({car.name})", plants, on_manoeuvre)


def compare_bmw(on_manoeuvre: Callable[[], None] = lambda: None) -> Comparison:
    """Drive our laws of motion and CommonRoad's, both with the numbers of the BMW 320i.

    Args:
        on_manoeuvre: Called after each manoeuvre.

    Raises:
        MissingPackageError: If the package with the multi-body model is not installed.
    """
    theirs = multi_body.MultiBodyCar()
    rig = bmw_320i.rig()
    plants = {"our laws": rig, **_single_track_cars(rig), MULTI_BODY: theirs}
    return _drive_all("BMW 320i", plants, on_manoeuvre)


def _single_track_cars(rig: Rig) -> dict[str, Plant]:
    lock, rate = rig.max_steering_angle, rig.car.parameters.max_steering_rate
    track = rig.single_track
    return {
        KINEMATIC: SingleTrackCar(track, max_steering_angle=lock, steering_rate=rate),
        LINEAR: LinearCar(track, max_steering_angle=lock, steering_rate=rate),
    }


def _drive_all(
    title: str, plants: Mapping[str, Plant], on_manoeuvre: Callable[[], None]
) -> Comparison:
    behaviours = {}
    for name, plant in plants.items():
        circles = {}
        for speed_kmh in SPEEDS_KMH:
            circles[speed_kmh] = steady_circle.circle(plant, speed_kmh)
            on_manoeuvre()
        step = step_steer.step(plant)
        on_manoeuvre()
        slides = name not in (KINEMATIC, LINEAR)
        behaviours[name] = Behaviour(circles, step, slides)
    return Comparison(title, behaviours)


def write(comparisons: Sequence[Comparison], path: Path) -> None:
    """Write every figure as JSON.

    Args:
        comparisons: What was compared.
        path: File to write.
    """
    content = {
        comparison.title: {
            model: {
                figure: {"unit": unit, "value": value if math.isfinite(value) else None}
                for figure, (unit, value) in behaviour.figures().items()
            }
            for model, behaviour in comparison.behaviours.items()
        }
        for comparison in comparisons
    }
    write_atomically(path, (json.dumps(content, indent=2) + "\n").encode())
