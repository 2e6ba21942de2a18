"""Time the bird's-eye view against the plain way to draw it: one warp a channel, each light asked on its own.

Both draw the same poses in turns (A B A B), and only the medians are compared: a busy machine slows both.

    python scripts/bench/bev.py
"""

import argparse
import time
from collections.abc import Callable

import cv2
import numpy as np

from mjdrive.bev.layers import LIGHT_LAYERS, LIGHT_VALUES, MARKED, Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig
from mjdrive.datatypes import Lane, Town
from mjdrive.geometry import headings
from mjdrive.town import library, routing, signals

Pose = tuple[float, float, float]


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
    ) -> np.ndarray:
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
                cv2.line(bev[layer], *ends, value, thickness)
        return bev

    def _view_from_world(self, x: float, y: float, yaw: float) -> np.ndarray:
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


def drive_poses(town: Town, count: int, rng: np.random.Generator) -> list[Pose]:
    """Poses of drives [m, m, rad]: 50 steps along each of many lanes."""
    poses: list[Pose] = []
    while len(poses) < count:
        name, _ = routing.random_start(town, rng)
        line = town.lanes[name].centerline
        steps = np.linspace(0.0, 1.0, 50)
        x, y = (np.interp(steps, np.linspace(0, 1, len(line)), line[:, axis]) for axis in (0, 1))
        yaw = headings(np.column_stack([x, y]))
        poses += zip(x.tolist(), y.tolist(), yaw.tolist(), strict=True)
    return poses[:count]


def time_per_frame(project: Callable[..., np.ndarray], poses: list[Pose]) -> float:
    """Mean time of the processor to draw a frame [s]."""
    start = time.thread_time()
    for number, (x, y, yaw) in enumerate(poses):
        project(x=x, y=y, yaw=yaw, time=0.1 * number, light_phase=0.0)
    return (time.thread_time() - start) / len(poses)


def main() -> None:
    """Print time a frame and the ratio of the two."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--town", default="town01", help="name of a town")
    parser.add_argument("--frames", type=int, default=400, help="poses a round")
    parser.add_argument("--rounds", type=int, default=11, help="rounds of each of the two")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    town = library.load(options.town)
    ours, plain = BevProjector(town), PlainProjector(town)
    poses = drive_poses(town, options.frames, np.random.default_rng(0))
    times = np.array(
        [
            [time_per_frame(ours.project, poses), time_per_frame(plain.project, poses)]
            for _ in range(options.rounds)
        ]
    )
    median, best = np.median(times, axis=0) * 1e3, times.min(axis=0) * 1e3
    print(f"{options.town}, {options.frames} poses, {options.rounds} rounds, one thread")
    print(f"BevProjector: {median[0]:.3f} ms a frame (median), {best[0]:.3f} ms (best)")
    print(f"plain:        {median[1]:.3f} ms a frame (median), {best[1]:.3f} ms (best)")
    print(f"ratio:        {np.median(times[:, 1] / times[:, 0]):.2f} (median of rounds)")


if __name__ == "__main__":
    main()
