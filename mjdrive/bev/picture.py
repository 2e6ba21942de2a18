"""A bird's-eye view as people like to look at it: road, lines, what the lights show now, and the car."""

import cv2
import numpy as np
from jaxtyping import UInt8

from mjdrive.bev.layers import LIGHT_VALUES, Layer
from mjdrive.config import BevConfig
from mjdrive.datatypes import Signal
from mjdrive.vehicle.parameters import VehicleParameters

Rgb = tuple[int, int, int]

GROUND: Rgb = (244, 245, 247)
ROAD: Rgb = (206, 211, 217)
LANE_LINE: Rgb = (140, 149, 159)
CAR: Rgb = (9, 105, 218)
LIGHTS: dict[Signal, Rgb] = {
    Signal.GREEN: (45, 164, 78),
    Signal.YELLOW: (219, 171, 9),
    Signal.RED: (207, 34, 46),
}

_SUBPIXELS = 4  # binary digits


def picture(
    bev: UInt8[np.ndarray, "C S S"], config: BevConfig, parameters: VehicleParameters, *, scale: int
) -> UInt8[np.ndarray, "H W 3"]:
    """Colour a bird's-eye view and draw the car where it is.

    Args:
        bev: Channels in the order of `Layer`.
        config: How the view was drawn, with grey lights.
        parameters: Of the car.
        scale: Pixels of the picture for one of the view [-].

    Returns:
        RGB picture, the car looking up.
    """
    image = np.full((*bev.shape[1:], 3), GROUND, np.uint8)
    image[bev[Layer.ROAD] > 0] = ROAD
    image[bev[Layer.LANE_LINES] > 0] = LANE_LINE
    for signal, value in LIGHT_VALUES.items():
        image[bev[Layer.LIGHTS_NOW] == value] = LIGHTS[signal]
    large = np.asarray(image.repeat(scale, axis=0).repeat(scale, axis=1))
    _draw_car(large, config, parameters, scale=scale)
    return large


def _draw_car(
    image: UInt8[np.ndarray, "H W 3"],
    config: BevConfig,
    parameters: VehicleParameters,
    *,
    scale: int,
) -> None:
    pixels_per_metre = scale * config.pixels_per_metre
    rear = pixels_per_metre * config.origin_ahead_of_rear_axle
    row = scale * (config.size_px - config.ego_above_bottom_px) + rear
    column = scale * config.size_px / 2
    tail = row + pixels_per_metre * parameters.rear_overhang
    nose = tail - pixels_per_metre * parameters.length
    half = pixels_per_metre * parameters.width / 2
    corners = [
        (column - half, tail),
        (column - half, nose),
        (column + half, nose),
        (column + half, tail),
    ]
    windscreen = nose + 0.3 * (tail - nose)
    glass = [(column - 0.8 * half, windscreen), (column + 0.8 * half, windscreen)]
    fine = np.rint(np.array(corners) * 2**_SUBPIXELS).astype(np.int32)
    cv2.fillPoly(image, [fine], CAR, cv2.LINE_AA, _SUBPIXELS)
    cv2.polylines(
        image,
        [np.rint(np.array(glass) * 2**_SUBPIXELS).astype(np.int32)],
        False,
        GROUND,
        max(1, scale),
        cv2.LINE_AA,
        _SUBPIXELS,
    )
