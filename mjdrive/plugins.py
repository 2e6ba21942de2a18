"""Policies, experts and towns that other packages bring along, found by their entry points.

A package is imported when what it brings is asked for by name, and by `mjdrive info`, so a broken one breaks nothing else.
"""

from importlib.metadata import EntryPoint, entry_points
from typing import Literal, NamedTuple, get_args

from mjdrive.errors import PluginError, UnknownNameError

Kind = Literal["policy", "expert", "town"]
"""What packages can bring along."""

GROUPS: dict[Kind, str] = {
    "policy": "mjdrive.policies",
    "expert": "mjdrive.experts",
    "town": "mjdrive.towns",
}
"""Groups of entry points."""


class Listed(NamedTuple):
    """A plug-in as `mjdrive info` shows it.

    Attributes:
        kind: What it is.
        name: How users call it.
        source: Package and version that bring it along.
        problem: Why it cannot be used, empty if it can.
    """

    kind: Kind
    name: str
    source: str
    problem: str


def names(kind: Kind) -> tuple[str, ...]:
    """List the plug-ins of a kind, in alphabetical order, without importing them."""
    return tuple(sorted(entry_points(group=GROUPS[kind]).names))


def load(kind: Kind, name: str) -> object:
    """Import what a plug-in points at.

    Args:
        kind: What it is.
        name: How users call it.

    Raises:
        UnknownNameError: If no package brings such a thing.
        PluginError: If several packages do, or importing it fails.
    """
    point = _find(kind, name)
    try:
        return point.load()
    except (
        Exception
    ) as error:  # whatever another package does wrong when it is imported is its own mistake
        raise PluginError(
            f"The {kind} '{name}' of {_source(point)} cannot be imported: {type(error).__name__}: {error}. Expected "
            f"{point.value} to exist; mend or remove that package. Others are not touched by it."
        ) from error


def source(kind: Kind, name: str) -> str:
    """Name the package that brings a plug-in along, and its version."""
    return _source(_find(kind, name))


def listing() -> tuple[Listed, ...]:
    """Import every plug-in, and tell which can be used."""
    listed = []
    for kind in get_args(Kind):
        for name in names(kind):
            problem, origin = "", ""
            try:
                origin = source(kind, name)
                load(kind, name)
            except PluginError as error:
                problem = str(error)
            listed.append(Listed(kind, name, origin, problem))
    return tuple(listed)


def _find(kind: Kind, name: str) -> EntryPoint:
    found = tuple(entry_points(group=GROUPS[kind], name=name))
    if not found:
        raise UnknownNameError(f"{kind} of another package", name, names(kind))
    if len(found) > 1:
        raise PluginError(
            f"The {kind} '{name}' is brought by {' and '.join(map(_source, found))}; expected one package. Remove the others."
        )
    return found[0]


def _source(point: EntryPoint) -> str:
    return "an unknown package" if point.dist is None else f"{point.dist.name} {point.dist.version}"
