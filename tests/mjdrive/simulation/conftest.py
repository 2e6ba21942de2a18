"""Crossroads small enough to reckon by hand, and a judge for hand-made drives over them.

Every drive is judged twice: as it is, and in a mirror, where traffic keeps to the left.
"""

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from functools import cache

import numpy as np
import pytest

from mjdrive.config import RulesConfig
from mjdrive.datatypes import Infraction, Lane, Signal, Town, TrafficLight, VehicleState
from mjdrive.simulation.rules import Rules
from mjdrive.vehicle.parameters import VehicleParameters

EDGE = 10.0
"""The junction is the square of this half side; stop lines lie on its edge [m]."""

FAR = 60.0
"""Streets end here [m]."""

Judge = Callable[..., list[tuple[str, str]]]


def _lane(id: str, points: Iterable[tuple[float, float]], junction: str | None = None) -> Lane:
    return Lane(id, np.array(list(points), float), 4.0, (), junction, None)


def _turned(points: np.ndarray, quarters: int) -> np.ndarray:
    for _ in range(quarters):
        points = np.stack([-points[:, 1], points[:, 0]], axis=1)
    return points


def _arc(middle: tuple[float, float], radius: float, start: float, end: float) -> np.ndarray:
    angles = np.radians(np.linspace(start, end, 21))
    return np.array(middle) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


@pytest.fixture(scope="session")
def crossroads() -> Town:
    """Four streets of two lanes, which drive on the right; every approach has a light, named like its lane.

    From the west, "west in" comes along y = -2 m and stops at x = -10 m; "west out" goes back along y = 2 m. The
    other three streets are this one turned by 90, 180 and 270 degrees: "south", "east", "north".
    """
    ways = {
        "in": np.array([[-FAR, -2.0], [-EDGE, -2.0]]),
        "out": np.array([[-EDGE, 2.0], [-FAR, 2.0]]),
        "straight": np.array([[-EDGE, -2.0], [EDGE, -2.0]]),
        "left": _arc((-EDGE, EDGE), 12.0, -90.0, 0.0),
        "right": _arc((-EDGE, -EDGE), 8.0, 90.0, 0.0),
    }
    lanes, lights = {}, {}
    for quarters, street in enumerate(("west", "south", "east", "north")):
        for way, points in ways.items():
            junction = None if way in ("in", "out") else "middle"
            id = f"{street} {way}"
            lanes[id] = _lane(id, map(tuple, _turned(points, quarters)), junction)
        line = _turned(np.array([[-EDGE, 0.0], [-EDGE, -4.0]]), quarters)
        id = f"{street} in"
        lanes[id] = dataclasses.replace(lanes[id], light=id)
        program = ((Signal.RED, 10.0),)
        yaw = quarters * np.pi / 2
        lights[id] = TrafficLight(id, id, "middle", line, yaw, line[1], program, 0.0)
    bounds = np.array([-FAR, -FAR, FAR, FAR])
    return Town("crossroads", lanes, lights, bounds, "")


def mirrored(town: Town) -> Town:
    """Put north for south, so that traffic changes sides."""
    flip = np.array([1.0, -1.0])
    lanes = {
        name: dataclasses.replace(lane, centerline=lane.centerline * flip)
        for name, lane in town.lanes.items()
    }
    lights = {
        name: dataclasses.replace(
            light,
            stop_line=light.stop_line[::-1] * flip,
            yaw=-light.yaw,
            pole=light.pole * flip,
        )
        for name, light in town.lights.items()
    }
    return dataclasses.replace(town, lanes=lanes, lights=lights)


def state(x: float, y: float, yaw: float = 0.0, speed: float = 5.0) -> VehicleState:
    """State whose footprint is centred on (x, y)."""
    car = VehicleParameters.default()
    ahead = car.length / 2 - car.rear_overhang
    return VehicleState(
        float(x - ahead * np.cos(yaw)),
        float(y - ahead * np.sin(yaw)),
        float(yaw),
        float(speed),
        0.0,
        0.0,
    )


@cache
def _rules(town: Town, is_mirrored: bool, settings: tuple[tuple[str, float], ...]) -> Rules:
    """Rules that many drives share; each drive resets them."""
    town = mirrored(town) if is_mirrored else town
    return Rules(town, VehicleParameters.default(), RulesConfig(**dict(settings)))


@pytest.fixture(params=["right-hand", "left-hand"])
def judge(request: pytest.FixtureRequest, crossroads: Town) -> Judge:
    """Judges a drive: poses (x, y, yaw, speed) of the centre of the car, 0.1 s apart.

    Every light is red unless `lights` says otherwise, for the whole drive or step by step. The answer is the kind
    and the cause of each infraction, or of those of `only` one kind.
    """
    sign = 1.0 if request.param == "right-hand" else -1.0

    def judge(
        poses: Iterable[tuple[float, ...]],
        *,
        town: Town | None = None,
        lights: Mapping[str, Signal] | Callable[[int], Mapping[str, Signal]] | None = None,
        only: str | None = None,
        **settings: float,
    ) -> list[tuple[str, str]]:
        town = town or crossroads
        rules = _rules(town, sign < 0, tuple(settings.items()))
        rules.reset()
        all_red = dict.fromkeys(town.lights, Signal.RED)
        found: list[Infraction] = []
        for step, (x, y, *rest) in enumerate(poses):
            yaw, *speed = rest or (0.0,)
            shown = lights(step) if callable(lights) else lights or {}
            found += rules.check(
                time=0.1 * (step + 1),
                vehicle=state(x, sign * y, sign * yaw, *speed),
                lights={**all_red, **shown},
                hits=(),
            )
        return [(it.kind.name, it.cause) for it in found if only in (None, it.kind.name)]

    return judge
