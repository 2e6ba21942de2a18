"""Red lights: the tail of the car on a stop line, as the Leaderboard has it."""

import math
from collections.abc import Mapping

import numpy as np

from mjdrive.config import RulesConfig
from mjdrive.datatypes import Signal, Town, TrafficLight
from mjdrive.town.lane_index import LaneIndex

Point = tuple[float, float]

_CELL = 16.0
"""Side of the squares that remember which lights are around them [m]."""


class RedLightWatch:
    """Watches the stop lines of a town for one drive.

    The tail is the stretch of the car's axis from 0.8 half lengths to a half length and 1 m behind its centre.
    A red light is run when the tail crosses the middle of its stop line, lies on its lane behind that and points along
    the lane. So that no car is too fast for this, the stretch back to where the tail was a step ago counts as tail.

    Args:
        town: Where the drive takes place.
        index: Lanes of the town.
        half_length: Of the car [m].
        config: Limits of the rules.

    Reference:
        RunningRedLightTest in CARLA's scenario_runner, as the Leaderboard 1.0 uses it.
    """

    def __init__(
        self, town: Town, index: LaneIndex, *, half_length: float, config: RulesConfig
    ) -> None:
        self._index = index
        self._config = config
        self._near_tail, self._far_tail = 0.8 * half_length, half_length + 1.0
        self._lights = tuple(town.lights.values())
        self._watched = [_watched(light, config.stop_line_share) for light in self._lights]
        self._middles = np.array([light.stop_line.mean(axis=0) for light in self._lights])
        self._nearby: dict[tuple[int, int], list[tuple[int, Point]]] = {}
        self.reset()

    def reset(self) -> None:
        """Forget the drive so far."""
        self._last_run: str | None = None
        self._tail_before: Point | None = None

    def check(self, centre: Point, yaw: float, lights: Mapping[str, Signal]) -> str | None:
        """Judge one control step.

        Args:
            centre: Centre of the footprint, world frame [m].
            yaw: Heading of the car [rad].
            lights: What every light shows now.

        Returns:
            Name of the red light that is run; the last one run counts again only after another one.
        """
        (x, y), cos, sin = centre, math.cos(yaw), math.sin(yaw)
        near_tail = (x - self._near_tail * cos, y - self._near_tail * sin)
        far_tail = (x - self._far_tail * cos, y - self._far_tail * sin)
        ends = [far_tail]
        if self._config.stop_line_sweep and self._tail_before is not None:
            ends.append(self._tail_before)  # what lies between two steps, too
        self._tail_before = near_tail
        for number, middle in self._lights_around(x, y):
            light = self._lights[number]
            if (
                math.dist(centre, middle) > self._config.light_distance
                or lights[light.id] is not Signal.RED
                or _signal(light) == self._last_run
            ):
                continue
            if math.cos(yaw - light.yaw) > 0 and any(
                self._comes_over(light, self._watched[number], near_tail, end) for end in ends
            ):
                self._last_run = _signal(light)
                return light.id
        return None

    def _lights_around(self, x: float, y: float) -> list[tuple[int, Point]]:
        """Numbers and stop lines of the lights that may be within `light_distance`, and of few others."""
        key = (math.floor(x / _CELL), math.floor(y / _CELL))
        if key not in self._nearby:
            middle_of_cell = (np.array(key) + 0.5) * _CELL
            reach = self._config.light_distance + _CELL  # more than half a diagonal
            off = np.hypot(*(self._middles.reshape(-1, 2) - middle_of_cell).T)
            found = np.flatnonzero(off <= reach).tolist()
            self._nearby[key] = [
                (number, tuple(self._middles[number].tolist())) for number in found
            ]
        return self._nearby[key]

    def _comes_over(
        self, light: TrafficLight, watched: tuple[Point, Point], start: Point, end: Point
    ) -> bool:
        """Whether a stretch crosses the watched part of a stop line and ends on the lane before it."""
        return _cross(*watched, start, end) and any(
            place.lane == light.lane for place in self._index.under(*end)
        )


def _signal(light: TrafficLight) -> str:
    """The signal of the map, which may stop several lanes."""
    return light.signal or light.id


def _watched(light: TrafficLight, share: float) -> tuple[Point, Point]:
    """Both ends of the watched middle of a stop line."""
    middle = light.stop_line.mean(axis=0)
    (x1, y1), (x2, y2) = (middle + 2 * share * (light.stop_line - middle)).tolist()
    return (x1, y1), (x2, y2)


def _cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Whether the segments a-b and c-d meet; ends count, parallel ones do not."""
    return _side(a, b, c) * _side(a, b, d) <= 0.0 and _side(c, d, a) * _side(c, d, b) < 0.0


def _side(start: Point, end: Point, point: Point) -> float:
    """Positive if a point lies on the left of a line, negative on the right [m2]."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])
