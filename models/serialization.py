"""Settings to JSON and back, strictly: no unknown name, no value of another type."""

import dataclasses
import json
from typing import Any, Literal, get_args, get_origin

import cattrs
from cattrs.v import format_exception

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


def _reason(error: BaseException, kind: Any) -> str:
    """What was wrong with one value, in the words of the check that refused it."""
    if isinstance(error, cattrs.ForbiddenExtraKeysError):
        names = ", ".join(field.name for field in dataclasses.fields(error.cl))
        return f"{format_exception(error, kind)}; expected {names}"
    if get_origin(kind) is Literal:
        value = str(error).partition(" not in literal")[0]
        return f"there is no '{value}'; expected {', '.join(map(str, get_args(kind)))}"
    if dataclasses.is_dataclass(kind) and isinstance(error, TypeError | AttributeError):
        return "it is no JSON object; expected one"
    if isinstance(error, SettingError | TypeError):
        return str(error)
    return format_exception(error, kind)


def _placed(reason: str) -> str:
    """A reason that begins with the place of what it is about, which cattrs puts at its end."""
    words, _, place = reason.rpartition(" @ ")
    return f"in {place}, {words.removesuffix('.')}"


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
        values = json.loads(text)
    except json.JSONDecodeError as error:
        raise SettingError(f"Cannot read settings: {error}. Expected a JSON object.") from error
    if not isinstance(values, dict):
        raise SettingError(f"Settings are a {type(values).__name__}; expected a JSON object.")
    try:
        return _CONVERTER.structure(values, LearnerConfig)
    except cattrs.BaseValidationError as error:
        found = cattrs.transform_error(error, path="settings", format_exception=_reason)
        reasons = "; ".join(_placed(reason) for reason in found)
        raise SettingError(f"Cannot read settings: {reasons}.") from error
