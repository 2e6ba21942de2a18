"""What each channel of the bird's-eye view means, and how five of them fit into one byte a pixel."""

from enum import IntEnum

import numpy as np
from jaxtyping import UInt8

from mjdrive.datatypes import Signal


class Layer(IntEnum):
    """Channel order of an observation."""

    ROAD = 0
    LANE_LINES = 1
    LIGHTS_OLDEST = 2
    LIGHTS_OLDER = 3
    LIGHTS_NOW = 4


LIGHT_LAYERS = (Layer.LIGHTS_OLDEST, Layer.LIGHTS_OLDER, Layer.LIGHTS_NOW)

MARKED = 255
"""Value of a road or lane-line pixel; the background is 0."""

LIGHT_VALUES = {Signal.GREEN: 80, Signal.YELLOW: 170, Signal.RED: 255}
"""Grey level of a stop line. Source: Zhang et al., Roach (ICCV 2021), BEV of the paper's code."""

_VALUE_OF_CODE = np.array([0, *LIGHT_VALUES.values()], np.uint8)


def pack(bev: UInt8[np.ndarray, "5 H W"]) -> UInt8[np.ndarray, "H W"]:
    """Pack a bird's-eye view into one byte a pixel; `unpack` undoes it.

    Bit 0 is the road, bit 1 the lane lines, then two bits for each light channel, oldest first.

    Args:
        bev: Channels in the order of `Layer`, values as drawn by the projector.

    Returns:
        One code a pixel.
    """
    code = (bev[Layer.ROAD] & 1) | (bev[Layer.LANE_LINES] & 2)
    for place, layer in enumerate(LIGHT_LAYERS):
        # The two highest bits tell nothing, green, yellow and red apart.
        code |= bev[layer] >> 6 << (2 + 2 * place)
    return code


def unpack(code: UInt8[np.ndarray, "*B H W"]) -> UInt8[np.ndarray, "*B 5 H W"]:
    """Restore the channels of packed bird's-eye views.

    Args:
        code: One code a pixel, any number of leading axes.

    Returns:
        Channels in the order of `Layer`.
    """
    bev = np.empty((*code.shape[:-2], len(Layer), *code.shape[-2:]), np.uint8)
    bev[..., Layer.ROAD, :, :] = (code & 1) * np.uint8(MARKED)
    bev[..., Layer.LANE_LINES, :, :] = (code >> 1 & 1) * np.uint8(MARKED)
    for place, layer in enumerate(LIGHT_LAYERS):
        bev[..., layer, :, :] = _VALUE_OF_CODE[code >> (2 + 2 * place) & 3]
    return bev
