"""What each channel of the bird's-eye view means, and how five of them fit into one byte a pixel."""

from enum import IntEnum

import numpy as np
from jaxtyping import UInt8

from mjdrive.config import BevConfig
from mjdrive.datatypes import Signal
from mjdrive.errors import ConfigError


class Layer(IntEnum):
    """The channels that every view has, in order; `BevConfig.extra_layers` follow in theirs."""

    ROAD = 0
    LANE_LINES = 1
    LIGHTS_OLDEST = 2
    LIGHTS_OLDER = 3
    LIGHTS_NOW = 4


LIGHT_LAYERS = (Layer.LIGHTS_OLDEST, Layer.LIGHTS_OLDER, Layer.LIGHTS_NOW)

MARKED = 255
"""Value of a marked pixel in every channel that shows no lights; the background is 0 everywhere."""

LIGHT_VALUES = {Signal.GREEN: 80, Signal.YELLOW: 170, Signal.RED: 255}
"""Grey level of a stop line. Source: Zhang et al., Roach (ICCV 2021), BEV of the paper's code."""

BINARY_LIGHT_VALUES = {Signal.GREEN: 0, Signal.YELLOW: 0, Signal.RED: 255}
"""The same where lights are binary, as the paper's text has them: red or nothing."""

_VALUE_OF_CODE = np.array([0, *LIGHT_VALUES.values()], np.uint8)


def light_values(config: BevConfig) -> dict[Signal, int]:
    """Tell which value a stop line has in a light channel, by what its light shows; 0 is not drawn."""
    return LIGHT_VALUES if config.light_values == "grey" else BINARY_LIGHT_VALUES


def channel_names(config: BevConfig) -> tuple[str, ...]:
    """Name every channel of a view in order: those of `Layer`, then the extra ones."""
    return (*(layer.name.lower() for layer in Layer), *config.extra_layers)


def pack(bev: UInt8[np.ndarray, "C H W"]) -> UInt8[np.ndarray, "H W"]:
    """Pack a bird's-eye view of five channels into one byte a pixel; `unpack` undoes it.

    Bit 0 is the road, bit 1 the lane lines, then two bits for each light channel, oldest first. That fills the byte:
    extra channels have no room. Grey and binary lights both survive.

    Args:
        bev: Channels in the order of `Layer`, values as drawn by the projector.

    Returns:
        One code a pixel.

    Raises:
        ConfigError: If the view has extra channels.
    """
    if len(bev) != len(Layer):
        raise ConfigError(
            f"A view of {len(bev)} channels was to be packed into one byte a pixel; expected the "
            f"{len(Layer)} of every view. Leave BevConfig.extra_layers empty, or keep the views as they are."
        )
    code = (bev[Layer.ROAD] & 1) | (bev[Layer.LANE_LINES] & 2)
    for place, layer in enumerate(LIGHT_LAYERS):
        # The two highest bits tell nothing, green, yellow and red apart.
        code |= (bev[layer] >> (4 - 2 * place)) & (0b11 << (2 + 2 * place))
    return code


def unpack(code: UInt8[np.ndarray, "*B H W"]) -> UInt8[np.ndarray, "*B 5 H W"]:
    """Restore the channels of packed bird's-eye views.

    Args:
        code: One code a pixel, any number of leading axes.

    Returns:
        Channels in the order of `Layer`, without extra ones.
    """
    bev = np.empty((*code.shape[:-2], len(Layer), *code.shape[-2:]), np.uint8)
    bev[..., Layer.ROAD, :, :] = (code & 1) * np.uint8(MARKED)
    bev[..., Layer.LANE_LINES, :, :] = (code >> 1 & 1) * np.uint8(MARKED)
    for place, layer in enumerate(LIGHT_LAYERS):
        bev[..., layer, :, :] = _VALUE_OF_CODE[code >> (2 + 2 * place) & 3]
    return bev
