"""Paint on the road: broken centre lines and stop lines."""

import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.datatypes import Town
from mjdrive.geometry import offset_polyline, resample

DASH_LENGTH = 3.0  # [m]; as long as the gap
DASH_WIDTH = 0.15  # [m]; 0.125 in the map, a little more to be seen
STOP_LINE_THICKNESS = 0.4  # along the lane [m]
STOP_LINE_INSET = 0.2  # at both ends [m]
SAME_LINE = 0.5  # left edges of opposite lanes closer than this are one centre line [m]


def centre_dashes(town: Town) -> list[Float[np.ndarray, "4 2"]]:
    """Dashes between opposite lanes outside junctions.

    Args:
        town: Road network.

    Returns:
        Corners of each dash, counter-clockwise, world frame [m].
    """
    dashes = []
    drawn: list[shapely.LineString] = []
    for lane in town.lanes.values():
        if lane.junction is not None:
            continue
        left_edge = offset_polyline(lane.centerline, 0.5 * lane.width)
        middle = shapely.Point(left_edge[len(left_edge) // 2])
        if any(line.distance(middle) < SAME_LINE for line in drawn):
            continue
        drawn.append(shapely.LineString(left_edge))
        points = resample(left_edge, DASH_LENGTH)
        dashes += [
            _strip(start, end, DASH_WIDTH)
            for start, end in zip(points[0:-1:2], points[1::2], strict=False)
        ]
    return dashes


def stop_bars(town: Town) -> list[Float[np.ndarray, "4 2"]]:
    """Bars across the approaches, their far edge on the stop line.

    Args:
        town: Road network.

    Returns:
        Corners of each bar, counter-clockwise, world frame [m].
    """
    bars = []
    for light in town.lights.values():
        left, right = light.stop_line
        across = (right - left) / np.hypot(*(right - left))
        back = -np.array([np.cos(light.yaw), np.sin(light.yaw)])
        middle = 0.5 * STOP_LINE_THICKNESS * back
        inset = STOP_LINE_INSET * across
        bars.append(_strip(left + inset + middle, right - inset + middle, STOP_LINE_THICKNESS))
    return bars


def _strip(
    start: Float[np.ndarray, "2"], end: Float[np.ndarray, "2"], width: float
) -> Float[np.ndarray, "4 2"]:
    forward = (end - start) / np.hypot(*(end - start))
    side = 0.5 * width * np.array([-forward[1], forward[0]])
    return np.array([start - side, end - side, end + side, start + side])
