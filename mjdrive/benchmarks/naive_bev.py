"""The bird's-eye view as plainly as it can be drawn: one warp a channel, each light asked on its own."""

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.bev.layers import LIGHT_LAYERS, LIGHT_VALUES, MARKED, Layer
from mjdrive.config import BevConfig
from mjdrive.datatypes import Lane, Town
from mjdrive.geometry import headings
from mjdrive.town import signals


class PlainProjector:
    """The five channels, drawn as simply as can be; `BevProjector` must give the same but for single pixels.

    Args:
        town: Road network to draw.
    """

    def __init__(self, town: Town) -> None:
        self._config = BevConfig()
        self._lights = tuple(town.lights.values())
        lines = np.array([light.stop_line for light in self._lights]).reshape(-1, 2, 2)
        middles = lines.mean(axis=1, keepdims=True)
        self._bars_world = middles + self._config.light_width_share * (lines - middles)
        left, bottom, right, top = town.bounds + np.array([-15, -15, 15, 15])
        scale = self._config.pixels_per_metre
        self._raster_from_world = np.array(
            [[scale, 0.0, -scale * left], [0.0, -scale, scale * top], [0.0, 0.0, 1.0]]
        )
        extent = np.array([right - left, top - bottom]) * scale
        width_px, height_px = np.ceil(extent).astype(int).tolist()
        self._road = np.zeros((height_px, width_px), np.uint8)
        self._lane_lines = np.zeros((height_px, width_px), np.uint8)
        for lane in town.lanes.values():
            self._draw_lane(lane)

    def project(
        self, *, x: float, y: float, yaw: float, time: float, light_phase: float
    ) -> UInt8[np.ndarray, "C S S"]:
        """Draw what the car sees; see `BevProjector.project`."""
        size = self._config.size_px
        view_from_world = self._view_from_world(x, y, yaw)
        view_from_raster = view_from_world @ np.linalg.inv(self._raster_from_world)
        bev = np.zeros((len(Layer), size, size), np.uint8)
        for layer, raster in ((Layer.ROAD, self._road), (Layer.LANE_LINES, self._lane_lines)):
            warped = cv2.warpAffine(raster, view_from_raster[:2], (size, size))
            cv2.threshold(warped, 0, MARKED, cv2.THRESH_BINARY, dst=bev[layer])
        bars = self._bars_world @ view_from_world[:2, :2].T + view_from_world[:2, 2]
        thickness = self._config.light_thickness_px
        inside = (bars.max(axis=1) > -thickness) & (bars.min(axis=1) < size + thickness)
        for index in np.flatnonzero(inside.all(axis=1)):
            ends = np.rint(bars[index]).astype(int).tolist()
            for layer, steps in zip(LIGHT_LAYERS, self._config.history_steps, strict=True):
                clock = max(time - steps * 0.1, 0.0) + light_phase
                value = LIGHT_VALUES[signals.at(self._lights[index], clock)]
                cv2.line(bev[layer], ends[0], ends[1], value, thickness)
        return bev

    def _view_from_world(self, x: float, y: float, yaw: float) -> Float[np.ndarray, "3 3"]:
        config, cos, sin = self._config, np.cos(yaw), np.sin(yaw)
        scale = config.pixels_per_metre
        row = config.size_px - config.ego_above_bottom_px + scale * config.origin_ahead_of_rear_axle
        view_from_vehicle = np.array(
            [[0.0, -scale, config.size_px / 2], [-scale, 0.0, row], [0.0, 0.0, 1.0]]
        )
        vehicle_from_world = np.array(
            [[cos, sin, -cos * x - sin * y], [-sin, cos, sin * x - cos * y], [0.0, 0.0, 1.0]]
        )
        return view_from_vehicle @ vehicle_from_world

    def _draw_lane(self, lane: Lane) -> None:
        yaw = headings(lane.centerline)
        left = np.stack([-np.sin(yaw), np.cos(yaw)], axis=1)
        widths = np.full(len(yaw), lane.width) if lane.widths is None else lane.widths
        edges = [
            self._to_pixels(lane.centerline + side * widths[:, None] / 2 * left)
            for side in (1.0, -1.0)
        ]
        outline = np.concatenate([edges[0], edges[1][::-1]])
        cv2.fillPoly(self._road, [outline], MARKED)
        cv2.polylines(self._road, [outline], True, MARKED, 4)  # which OpenCV draws 5 px wide
        if lane.junction is None:
            cv2.polylines(self._lane_lines, edges, False, MARKED, 1)

    def _to_pixels(self, points: np.ndarray) -> np.ndarray:
        raster = points @ self._raster_from_world[:2, :2].T + self._raster_from_world[:2, 2]
        return np.rint(raster).astype(np.int32)
