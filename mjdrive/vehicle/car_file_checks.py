"""What a car file must leave to the scene that it is put into: the file becomes a part of the whole town."""

from collections.abc import Iterator

import mujoco
import numpy as np

# What the geoms and meshes of a town would inherit from the unnamed default class of the car.
_INHERITED = {
    "geom": (
        "type", "size", "contype", "conaffinity", "condim", "priority", "friction", "solmix", "solref", "solimp",
        "margin", "gap", "mass", "density", "group", "rgba",
    ),
    "mesh": ("scale", "inertia", "maxhullvert"),
}  # fmt: skip


def file_faults(spec: mujoco.MjSpec) -> Iterator[str]:
    """Name everything in a car file that would change the world around the car.

    Args:
        spec: The file, read and not yet compiled.

    Yields:
        What was found, what was expected and what to do, one clause each.
    """
    plain = mujoco.MjSpec()
    options = _differences(spec.option, plain.option, _names(plain.option))
    if options:
        yield f"<option> sets {', '.join(options)}, which belong to the scene: leave <option> out"
    for kind, names in _INHERITED.items():
        changed = _differences(getattr(spec.default, kind), getattr(plain.default, kind), names)
        if changed:
            yield (
                f"the unnamed default class sets {', '.join(changed)} of {kind}, which the whole town would "
                f"inherit: put them into a class of their own"
            )
    if spec.compiler.discardvisual:
        yield "<compiler> sets discardvisual, which would discard the town: leave it out"
    if spec.pairs:
        yield f"<contact> holds {len(spec.pairs)} pairs; expected none: mjdrive pairs the tyres with the road"
    strangers = [
        f"{kind} '{element.name}'"
        for kind in ("bodies", "geoms", "lights", "cameras", "sites")
        for element in getattr(spec.worldbody, kind)
        if (kind, element.name) != ("bodies", "car")
    ]
    if strangers:
        yield f"<worldbody> holds {', '.join(strangers)}; expected the body 'car' alone"


def _names(element: object) -> list[str]:
    return [name for name in dir(element) if not name.startswith("_")]


def _differences(found: object, plain: object, names: list[str] | tuple[str, ...]) -> list[str]:
    return [
        name
        for name in names
        if not np.array_equal(
            np.asarray(getattr(found, name), float),
            np.asarray(getattr(plain, name), float),
            equal_nan=True,
        )
    ]
