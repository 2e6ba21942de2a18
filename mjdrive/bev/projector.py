"""Town + pose + time -> the five channels that a policy sees. A pure function: nothing is remembered between calls.

Source of the conventions: Roach's chauffeurnet renderer and the paper's configuration of it (five channels, history
-16, -9, -1 at 10 Hz; docs/decisions.md); the rasters are drawn once, every frame is one affine warp.
"""

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from mjdrive import geometry
from mjdrive.bev.layers import LIGHT_LAYERS, LIGHT_VALUES, MARKED, Layer
from mjdrive.config import BevConfig
from mjdrive.datatypes import Town
from mjdrive.town import signals

_MARGIN = 15.0
"""Empty border of the town raster [m]."""


class BevProjector:
    """Draws the bird's-eye view of one town.

    Args:
        town: Road network to draw.
        control_interval: Time between two decisions, the unit of the light history [s].
        config: How the view is drawn.
    """

    def __init__(
        self, town: Town, *, control_interval: float = 0.1, config: BevConfig | None = None
    ) -> None:
        self.config = config or BevConfig()
        self._history = [steps * control_interval for steps in self.config.history_steps]
        self._lights = tuple(town.lights.values())
        self._light_lines_world = np.array(
            [_drawn_line(town, light.id, self.config) for light in self._lights]
        )
        self._raster_from_world = _raster_from_world(town, self.config.pixels_per_metre)
        self._rasters = _draw_town(town, self._raster_from_world, self.config)

    def project(
        self, *, x: float, y: float, yaw: float, time: float, light_phase: float
    ) -> UInt8[np.ndarray, "5 H W"]:
        """Draw what the car sees.

        Args:
            x: Rear-axle centre, world frame [m].
            y: Rear-axle centre, world frame [m].
            yaw: Heading [rad].
            time: Simulation time since reset [s]; the light history does not reach before 0.
            light_phase: Time into the light cycle at reset [s].

        Returns:
            Channels in the order of `layers.Layer`, row 0 farthest ahead, column 0 farthest left.
        """
        size = self.config.size_px
        view_from_world = self._view_from_world(x, y, yaw)
        view_from_raster = view_from_world @ np.linalg.inv(self._raster_from_world)
        bev = np.zeros((len(Layer), size, size), np.uint8)
        for layer, raster in self._rasters.items():
            warped = cv2.warpAffine(raster, view_from_raster[:2], (size, size))
            # Any touched pixel counts, as in the original, so thin lines stay unbroken at every angle.
            cv2.threshold(warped, 0, MARKED, cv2.THRESH_BINARY, dst=bev[layer])
        self._draw_lights(bev, view_from_world, time, light_phase)
        return bev

    def _view_from_world(self, x: float, y: float, yaw: float) -> Float[np.ndarray, "3 3"]:
        scale = self.config.pixels_per_metre
        cos, sin = np.cos(yaw), np.sin(yaw)
        ahead = self.config.origin_ahead_of_rear_axle
        column = self.config.size_px / 2
        row = self.config.size_px - self.config.ego_above_bottom_px + scale * ahead
        # vehicle y is left of the car: columns fall with y, rows fall with x.
        view_from_vehicle = np.array([[0.0, -scale, column], [-scale, 0.0, row], [0.0, 0.0, 1.0]])
        vehicle_from_world = np.array(
            [[cos, sin, -cos * x - sin * y], [-sin, cos, sin * x - cos * y], [0.0, 0.0, 1.0]]
        )
        return view_from_vehicle @ vehicle_from_world

    def _draw_lights(
        self,
        bev: UInt8[np.ndarray, "5 H W"],
        view_from_world: Float[np.ndarray, "3 3"],
        time: float,
        light_phase: float,
    ) -> None:
        lines = self._light_lines_world @ view_from_world[:2, :2].T + view_from_world[:2, 2]
        size, margin = self.config.size_px, self.config.light_thickness_px
        seen = np.all((lines.max(axis=1) > -margin) & (lines.min(axis=1) < size + margin), axis=1)
        for index in np.flatnonzero(seen):
            start, end = np.rint(lines[index]).astype(int).tolist()
            for layer, age in zip(LIGHT_LAYERS, self._history, strict=True):
                shown = signals.at(self._lights[index], max(time - age, 0.0) + light_phase)
                cv2.line(
                    bev[layer], start, end, LIGHT_VALUES[shown], self.config.light_thickness_px
                )


def _drawn_line(town: Town, light_id: str, config: BevConfig) -> Float[np.ndarray, "2 2"]:
    """The part of a stop line that is drawn: a share of the lane width about its middle [m]."""
    stop_line = town.lights[light_id].stop_line
    return stop_line.mean(axis=0) + config.light_width_share * (stop_line - stop_line.mean(axis=0))


def _raster_from_world(town: Town, pixels_per_metre: float) -> Float[np.ndarray, "3 3"]:
    """Map world coordinates [m] to (column, row) of the town raster [px], north up."""
    left, _, _, top = town.bounds + np.array([-1, -1, 1, 1]) * _MARGIN
    scale = pixels_per_metre
    return np.array([[scale, 0.0, -scale * left], [0.0, -scale, scale * top], [0.0, 0.0, 1.0]])


def _draw_town(
    town: Town, raster_from_world: Float[np.ndarray, "3 3"], config: BevConfig
) -> dict[Layer, UInt8[np.ndarray, "H W"]]:
    """Draw road and lane lines of a whole town, once."""
    extent = (town.bounds[2:] - town.bounds[:2] + 2 * _MARGIN) * config.pixels_per_metre
    width_px, height_px = np.ceil(extent).astype(int).tolist()
    road = np.zeros((height_px, width_px), np.uint8)
    lane_lines = np.zeros((height_px, width_px), np.uint8)

    def to_pixels(points: Float[np.ndarray, "N 2"]) -> np.ndarray:
        raster = points @ raster_from_world[:2, :2].T + raster_from_world[:2, 2]
        return np.rint(raster).astype(np.int32)

    for lane in town.lanes.values():
        edges = [
            geometry.offset_polyline(lane.centerline, side * lane.width / 2) for side in (1, -1)
        ]
        outline = to_pixels(np.concatenate([edges[0], edges[1][::-1]]))
        cv2.fillPoly(road, [outline], MARKED)
        cv2.polylines(road, [outline], True, MARKED, config.road_outline_px)
        if lane.junction is None:
            cv2.polylines(lane_lines, [to_pixels(edge) for edge in edges], False, MARKED, 1)
    return {Layer.ROAD: road, Layer.LANE_LINES: lane_lines}
