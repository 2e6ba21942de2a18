"""Frozen settings, their presets, and how they are written to and read from JSON."""

import dataclasses
import json
from pathlib import Path
from typing import Any, TypeVar

import cattrs

from mjdrive.errors import ConfigError

Config = TypeVar("Config")

_CONVERTER = cattrs.Converter(forbid_extra_keys=True)


def to_json(config: object) -> str:
    """Write a frozen settings dataclass as JSON text."""
    return json.dumps(_CONVERTER.unstructure(config), indent=2) + "\n"


def from_dict(kind: type[Config], values: dict[str, Any]) -> Config:
    """Build settings from plain values.

    Args:
        kind: Dataclass to build.
        values: Field values as JSON gives them; missing fields keep their defaults.

    Returns:
        The checked settings.

    Raises:
        ConfigError: If a name is unknown or a value has the wrong type or range.
    """
    try:
        return _CONVERTER.structure(values, kind)
    except (cattrs.BaseValidationError, TypeError, ValueError) as error:
        reasons = "; ".join(cattrs.transform_error(error, path=kind.__name__))
        names = ", ".join(field.name for field in dataclasses.fields(kind))  # type: ignore[arg-type]
        raise ConfigError(
            f"Cannot read {kind.__name__}: {reasons}. Its settings are: {names}."
        ) from error


def read_json(kind: type[Config], path: Path) -> Config:
    """Read settings that `to_json` wrote.

    Raises:
        ConfigError: If the file is no JSON or does not fit the dataclass.
    """
    try:
        values = json.loads(path.read_text())
    except (OSError, json.JSONDecodeError) as error:
        raise ConfigError(
            f"Cannot read settings from '{path}': {error}. Expected a JSON object."
        ) from error
    return from_dict(kind, values)


def require(condition: bool, message: str) -> None:
    """Refuse a setting.

    Args:
        condition: What must hold.
        message: What was given and what was expected.

    Raises:
        ConfigError: If the condition does not hold.
    """
    if not condition:
        raise ConfigError(message)


@dataclasses.dataclass(frozen=True, slots=True)
class BevConfig:
    """How the bird's-eye view is drawn (defaults: the paper's).

    Attributes:
        size_px: Width and height of the picture [px].
        pixels_per_metre: Resolution [px/m].
        ego_above_bottom_px: Row of the vehicle origin, counted from the lower edge [px].
        history_steps: Control steps back to each light channel, oldest first; 0 is now [-].
        light_width_share: Length of a drawn stop line over the lane width [-].
        light_thickness_px: Thickness of a drawn stop line [px].
        road_outline_px: Width of the outline drawn around each lane of the road channel [px].
        origin_ahead_of_rear_axle: Where the picture's ego point lies on the car, ahead of the rear axle [m].
    """

    size_px: int = 192
    pixels_per_metre: float = 5.0
    ego_above_bottom_px: int = 40
    history_steps: tuple[int, int, int] = (15, 8, 0)
    light_width_share: float = 0.8
    light_thickness_px: int = 6
    road_outline_px: int = 5
    origin_ahead_of_rear_axle: float = 1.35

    def __post_init__(self) -> None:
        require(self.size_px >= 16, f"size_px is {self.size_px}; expected at least 16.")
        require(
            self.pixels_per_metre > 0,
            f"pixels_per_metre is {self.pixels_per_metre}; expected a positive number.",
        )


@dataclasses.dataclass(frozen=True, slots=True)
class SimulationConfig:
    """How the world is stepped.

    Attributes:
        timestep: Length of one physics step [s].
        control_interval: Time between two decisions [s].
        car_update_interval: Time between two updates of tyre, brake and drag parameters [s].
        settle_time: Time that a new car is given to come to rest on its springs [s].
    """

    timestep: float = 0.005
    control_interval: float = 0.1
    car_update_interval: float = 0.02
    settle_time: float = 1.0

    def __post_init__(self) -> None:
        for longer, shorter in (
            ("control_interval", "car_update_interval"),
            ("car_update_interval", "timestep"),
        ):
            ratio = getattr(self, longer) / getattr(self, shorter)
            require(
                ratio >= 1 and abs(ratio - round(ratio)) < 1e-9,
                f"{longer} is {getattr(self, longer)} s and {shorter} is {getattr(self, shorter)} s; "
                f"expected a whole number of the second in the first.",
            )
