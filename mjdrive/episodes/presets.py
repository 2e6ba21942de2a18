"""Named settings of `collect`."""

import dataclasses

from mjdrive.config import CollectConfig, DisturbanceConfig, require
from mjdrive.errors import UnknownNameError


def collect_preset(name: str) -> CollectConfig:
    """Settings of `collect` by name: "standard", "quick" (three routes) or "paper" (no disturbance).

    Raises:
        UnknownNameError: If there is no preset of that name.
    """
    presets = {
        "standard": CollectConfig(),
        "quick": CollectConfig(routes=("route0", "route1", "route4")),
        "paper": CollectConfig(disturbance=None),
    }
    if name not in presets:
        raise UnknownNameError("collect preset", name, presets)
    return presets[name]


def with_noise(config: CollectConfig, scale: float) -> CollectConfig:
    """Change how much a collection is disturbed.

    Args:
        config: Settings to change.
        scale: Factor on the standard amplitude of steering pulses and rate of stops; 0 disturbs nothing [-].

    Returns:
        The changed settings.

    Raises:
        ConfigError: If the scale is negative or makes pulses larger than full lock.
    """
    require(scale >= 0, f"noise is {scale}; expected 0 or more.")
    if scale == 0:
        return dataclasses.replace(config, disturbance=None)
    standard = DisturbanceConfig()
    disturbance = dataclasses.replace(
        standard,
        steering_amplitude=scale * standard.steering_amplitude,
        stop_rate_per_min=scale * standard.stop_rate_per_min,
    )
    return dataclasses.replace(config, disturbance=disturbance)
