"""Settings to JSON and back, strictly: no unknown name, no value of another type."""

import dataclasses
import json
from typing import Any

import cattrs

from models.config import LearnerConfig
from models.errors import SettingError


def _strict_converter() -> cattrs.Converter:
    """A converter that never bends a value into a type, as int("3") or bool("no") would."""
    converter = cattrs.Converter(forbid_extra_keys=True)
    accepted: dict[type, tuple[type, ...]] = {
        bool: (bool,),
        int: (int,),
        float: (float, int),
        str: (str,),
    }
    for kind, types in accepted.items():

        def structure(
            value: Any, target: type, kind: type = kind, types: tuple[type, ...] = types
        ) -> Any:
            if not isinstance(value, types) or (kind is not bool and isinstance(value, bool)):
                raise TypeError(f"{value!r} is no {kind.__name__}")
            return kind(value)

        converter.register_structure_hook(kind, structure)
    return converter


_CONVERTER = _strict_converter()


def to_json(config: LearnerConfig) -> str:
    """Write settings as JSON text."""
    return json.dumps(_CONVERTER.unstructure(config), indent=2) + "\n"


def from_json(text: str) -> LearnerConfig:
    """Read settings that `to_json` wrote; missing ones keep their defaults.

    Raises:
        SettingError: If the text is no JSON object, or a name, type or range is wrong.
    """
    try:
        return _CONVERTER.structure(json.loads(text), LearnerConfig)
    except json.JSONDecodeError as error:
        raise SettingError(f"Cannot read settings: {error}. Expected a JSON object.") from error
    except (cattrs.BaseValidationError, TypeError, ValueError) as error:
        reasons = "; ".join(cattrs.transform_error(error, path="settings"))
        names = ", ".join(field.name for field in dataclasses.fields(LearnerConfig))
        raise SettingError(f"Cannot read settings: {reasons}. Expected: {names}.") from error
