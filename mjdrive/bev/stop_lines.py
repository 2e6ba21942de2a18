"""The light channels: a bar at each stop line, in the colour that its light shows."""

import math

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.bev.layers import LIGHT_LAYERS, Layer, light_values
from mjdrive.config import BevConfig
from mjdrive.datatypes import Town, TrafficLight
from mjdrive.town import signals

Point = tuple[float, float]
Pixel = tuple[int, int]

_Bar = tuple[int, float, float, float, float, float, float]
"""Number of a light, middle and both ends of its bar, world frame [m]."""

_CELL = 16.0
"""Side of the squares that remember which lights are around them [m]."""


class StopLines:
    """Draws the stop lines of one town.

    Args:
        town: Road network.
        control_interval: Time between two decisions, the unit of the light history [s].
        config: How the view is drawn.
    """

    def __init__(self, town: Town, *, control_interval: float, config: BevConfig) -> None:
        lights = tuple(town.lights.values())
        self._config = config
        self._ages = [steps * control_interval for steps in config.history_steps]
        self._values = light_values(config)
        self._bars_world = np.array([_bar(light, config) for light in lights]).reshape(-1, 2, 2)
        self._middles_world = self._bars_world.mean(axis=1)
        self._reach = min(config.light_range, _farthest_visible(self._bars_world, config))
        # Lights that change together are asked once a frame.
        cycles = [signals.Cycle.of(light) for light in lights]
        self._cycles = list(dict.fromkeys(cycles))
        self._group = [self._cycles.index(cycle) for cycle in cycles]
        self._cells: dict[tuple[int, int], list[_Bar]] = {}
        self._margin_px = config.light_thickness_px

    def draw(
        self,
        bev: UInt8[np.ndarray, "C S S"],
        view_from_world: Float[np.ndarray, "3 3"],
        *,
        ego_world: tuple[float, float],
        time: float,
        light_phase: float,
    ) -> None:
        """Draw the bars near the car into the light channels of a view, past ones in the frame of now.

        Args:
            bev: View to draw into.
            view_from_world: From the world frame [m] to (column, row) [px].
            ego_world: The ego point of the view [m].
            time: Simulation time since reset [s]; the history does not reach before 0.
            light_phase: Time into the light cycle at reset [s].
        """
        bars = self._seen(ego_world, view_from_world, size_px=bev.shape[1])
        if not bars:
            return
        clocks = [max(time - age, 0.0) + light_phase for age in self._ages]
        drawn: dict[tuple[int, ...], Layer] = {}
        for layer, clock in zip(LIGHT_LAYERS, clocks, strict=True):
            values = self._values_at(clock, bars)
            if values in drawn:  # lights seldom change: most channels look alike
                bev[layer] = bev[drawn[values]]
                continue
            drawn[values] = layer
            channel = bev[layer]
            for (_, start, end), value in zip(bars, values, strict=True):
                if value:
                    cv2.line(channel, start, end, value, self._config.light_thickness_px)

    def _seen(
        self, ego_world: Point, view_from_world: Float[np.ndarray, "3 3"], *, size_px: int
    ) -> list[tuple[int, Pixel, Pixel]]:
        """Number, start and end of each bar that reaches into a view; a few numbers need no numpy."""
        x, y = ego_world
        key = (math.floor(x / _CELL), math.floor(y / _CELL))
        around = self._cells.get(key)
        if around is None:
            around = self._cells[key] = self._around(*key)
        if not around:
            return []
        (a, b, left), (c, d, top), _ = view_from_world.tolist()
        low, high = -self._margin_px, size_px + self._margin_px
        most = self._reach**2
        seen = []
        for light, middle_x, middle_y, start_x, start_y, end_x, end_y in around:
            off_x, off_y = middle_x - x, middle_y - y
            if off_x * off_x + off_y * off_y > most:
                continue
            row_1, row_2 = c * start_x + d * start_y + top, c * end_x + d * end_y + top
            if (row_1 > high and row_2 > high) or (row_1 < low and row_2 < low):
                continue  # most that are not seen are behind the car
            column_1, column_2 = a * start_x + b * start_y + left, a * end_x + b * end_y + left
            if (column_1 > high and column_2 > high) or (column_1 < low and column_2 < low):
                continue
            start, end = (round(column_1), round(row_1)), (round(column_2), round(row_2))
            seen.append((light, start, end))
        return seen

    def _around(self, column: int, row: int) -> list[_Bar]:
        """All bars that are near somewhere in one square, and of few others."""
        middle = (column + 0.5) * _CELL, (row + 0.5) * _CELL
        off = np.hypot(*(self._middles_world - middle).T)
        found = np.flatnonzero(off <= self._reach + _CELL)  # more than half a diagonal
        numbers = np.column_stack([self._middles_world, self._bars_world.reshape(-1, 4)])
        return [(light, *numbers[light].tolist()) for light in found.tolist()]

    def _values_at(self, clock: float, bars: list[tuple[int, Pixel, Pixel]]) -> tuple[int, ...]:
        values: dict[int, int] = {}
        shown = []
        for light, *_ in bars:
            group = self._group[light]
            if group not in values:
                values[group] = self._values[self._cycles[group].at(clock)]
            shown.append(values[group])
        return tuple(shown)


def _farthest_visible(bars_world: Float[np.ndarray, "L 2 2"], config: BevConfig) -> float:
    """A bar whose middle is farther than this from the ego point does not reach into the view [m]."""
    ahead = config.size_px - config.ego_above_bottom_px
    corner = np.hypot(max(abs(ahead), abs(config.ego_above_bottom_px)), config.size_px / 2)
    longest = np.hypot(*(bars_world[:, 1] - bars_world[:, 0]).T).max(initial=0.0)
    return float((corner + config.light_thickness_px) / config.pixels_per_metre + longest)


def _bar(light: TrafficLight, config: BevConfig) -> Float[np.ndarray, "2 2"]:
    """The part of a stop line that is drawn: a share of the lane width about its middle [m]."""
    middle = light.stop_line.mean(axis=0)
    return middle + config.light_width_share * (light.stop_line - middle)
