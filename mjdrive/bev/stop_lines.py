"""The light channels: a bar at each stop line, in the colour that its light shows."""

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.bev.layers import LIGHT_LAYERS, Layer, light_values
from mjdrive.config import BevConfig
from mjdrive.datatypes import Town, TrafficLight
from mjdrive.town import signals


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
        programs = [(light.program, light.offset) for light in lights]
        self._group = [programs.index(program) for program in programs]
        self._lights = lights

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
        offsets = self._middles_world - ego_world
        near = np.flatnonzero(np.square(offsets).sum(axis=1) <= self._reach**2).tolist()
        if not near:
            return
        bars = self._bars_world[near] @ view_from_world[:2, :2].T + view_from_world[:2, 2]
        ends = np.rint(bars).astype(int).tolist()
        clocks = [max(time - age, 0.0) + light_phase for age in self._ages]
        drawn: dict[tuple[int, ...], Layer] = {}
        for layer, clock in zip(LIGHT_LAYERS, clocks, strict=True):
            values = self._values_at(clock, near)
            if values in drawn:  # lights seldom change: most channels look alike
                bev[layer] = bev[drawn[values]]
                continue
            drawn[values] = layer
            for (start, end), value in zip(ends, values, strict=True):
                if value:
                    cv2.line(bev[layer], start, end, value, self._config.light_thickness_px)

    def _values_at(self, clock: float, lights: list[int]) -> tuple[int, ...]:
        groups = [self._group[light] for light in lights]
        values = {
            group: self._values[signals.at(self._lights[group], clock)] for group in set(groups)
        }
        return tuple(values[group] for group in groups)


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
