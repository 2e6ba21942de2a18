"""Frozen settings to and from JSON, strictly."""

import dataclasses
import json
from pathlib import Path
from typing import Any, TypeVar

import cattrs
from cattrs.v import format_exception

from mjdrive.errors import ConfigError
from mjdrive.files import write_atomically

Config = TypeVar("Config")

_CONVERTER = cattrs.Converter(forbid_extra_keys=True)


def to_json(config: object) -> str:
    """Write a frozen settings dataclass as JSON text."""
    return json.dumps(_CONVERTER.unstructure(config), indent=2) + "\n"


def write_json(config: object, path: Path) -> None:
    """Write a frozen dataclass as a JSON file, whole or not at all."""
    write_atomically(path, to_json(config).encode())


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
        reasons = "; ".join(
            cattrs.transform_error(error, path=kind.__name__, format_exception=_reason)
        )
        names = ", ".join(field.name for field in dataclasses.fields(kind))  # type: ignore[arg-type]
        raise ConfigError(
            f"Cannot read {kind.__name__}: {reasons}. Its settings are: {names}."
        ) from error


def _reason(error: BaseException, kind: Any) -> str:
    """Say what is wrong with a value: in the words of the setting that refused it, if it did."""
    if isinstance(error, ConfigError):
        return str(error)
    detail = f" ({error})" if isinstance(error, ValueError) and str(error) else ""
    return format_exception(error, kind) + detail


def read_json(kind: type[Config], path: Path) -> Config:
    """Read settings that `to_json` wrote.

    Raises:
        ConfigError: If the file is no JSON or does not fit the dataclass.
    """
    try:
        values = json.loads(path.read_text())
    except (OSError, ValueError) as error:  # no JSON, or no text at all
        raise ConfigError(
            f"Cannot read settings from '{path}': {error}. Expected a JSON object."
        ) from error
    require(
        isinstance(values, dict),
        f"Cannot read settings from '{path}': it holds a {type(values).__name__}; expected a JSON object.",
    )
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
