"""A number without a unit is a defect."""

import dataclasses
import inspect
import re
import types
import typing

import pytest

import mjdrive.config.driving_env
import mjdrive.config.mpc
import mjdrive.config.settings
import mjdrive.datatypes
import mjdrive.datatypes.driving
import mjdrive.datatypes.town
import models.config

UNITS = {
    "-", "m", "m/s", "m/s2", "m/s^2", "rad", "rad/s", "s", "px", "px/m", "kg", "N", "N/rad", "Hz", "nats",
    "1/m", "1/min", "1/s", "m/s3", "rad/s2", "1/(m/s)", "1/(m/s2)", "1/rad", "1/(rad s)", "s/rad", "s3/m2", "%",
}  # fmt: skip
DIMENSIONLESS_COUNTS = {
    "seed",
    "index",
    "lane_index",
    "count",
    "epochs",
    "epoch",
    "points",
    "iterations",
    "batch_size",
}
COUNT_PREFIXES = ("num_",)
UNITLESS = {
    "physics",  # mixed, and said so
    "on_lane",  # flags
}


def numeric_dataclasses() -> list[type]:
    modules = (
        mjdrive.datatypes.town,
        mjdrive.datatypes.driving,
        mjdrive.config.driving_env,
        mjdrive.config.mpc,
        mjdrive.config.settings,
        models.config,
    )
    return [
        kind
        for module in modules
        for _, kind in inspect.getmembers(module, inspect.isclass)
        if dataclasses.is_dataclass(kind)
        and (kind.__module__ + ".").startswith(module.__name__ + ".")
    ]


def attribute_lines(kind: type) -> dict[str, str]:
    """The text of each field in the Attributes section of a class docstring."""
    section = inspect.getdoc(kind).partition("Attributes:\n")[2].partition("\n\n")[0]
    return dict(re.findall(r"^ {4}(\w+): (.*(?:\n {8,}.*)*)", section, flags=re.MULTILINE))


def is_number(annotation: object) -> bool:
    """Whether a field holds a number, an array of numbers or a tuple of them."""
    if isinstance(annotation, str):
        return bool(re.search(r"\b(int|float|Float|ndarray)\b", annotation))
    if annotation in (int, float):
        return True
    if typing.get_origin(annotation) in (tuple, typing.Union, types.UnionType):
        return any(is_number(inner) for inner in typing.get_args(annotation))
    name = getattr(annotation, "__name__", "") or str(annotation)
    return name.startswith(("Float", "UInt8", "ndarray"))


def units_in(text: str) -> set[str]:
    return set(re.findall(r"\[([^\[\]]*)\]", text))


@pytest.mark.parametrize("kind", numeric_dataclasses(), ids=lambda kind: kind.__qualname__)
def test_every_field_is_described(kind: type) -> None:
    assert set(attribute_lines(kind)) == {field.name for field in dataclasses.fields(kind)}


@pytest.mark.parametrize("kind", numeric_dataclasses(), ids=lambda kind: kind.__qualname__)
def test_every_number_has_a_unit(kind: type) -> None:
    bare, unknown = [], set()
    lines = attribute_lines(kind)
    for field in dataclasses.fields(kind):
        if not is_number(field.type):
            continue
        found = {unit for unit in units_in(lines[field.name]) if "," not in unit}  # no interval
        is_count = field.name in DIMENSIONLESS_COUNTS or field.name.startswith(COUNT_PREFIXES)
        if not (found or is_count or field.name in UNITLESS):
            bare.append(field.name)
        unknown |= found - UNITS
    assert not bare, f"{kind.__name__} has numbers without a unit: {', '.join(bare)}"
    assert not unknown, f"{kind.__name__} has units that are not in the list: {unknown}"


def test_the_walk_finds_numbers() -> None:
    found = {kind.__name__ for kind in numeric_dataclasses()}
    assert {"VehicleState", "Episode", "BevConfig", "MpcConfig", "OptimiserConfig"} <= found
    assert is_number(float)
    assert is_number(tuple[int, int])
    assert is_number(float | None)
    assert is_number(
        {field.name: field.type for field in dataclasses.fields(mjdrive.datatypes.Episode)}["time"]
    )
    assert not is_number(str)
