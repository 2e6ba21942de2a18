"""Things that stand where cars drive."""

from collections.abc import Iterator
from typing import NamedTuple

import shapely

from mjdrive.datatypes import StaticObject, Town
from mjdrive.town.surface import lane_polygons

_REACH = 0.1
"""Things may reach this far over the edge of a lane, as kerbs and barriers of sound maps do [m]."""

_ON_THE_GROUND = 0.05
"""Objects up to this height are paint, here as in the scenery, which is laid out above this floor [m]."""

_THIN = 0.05
"""Radius of posts and trunks, whatever their model shows [m]."""


class Obstruction(NamedTuple):
    """A thing and what it stands on.

    Attributes:
        thing: Its name in the map.
        what: The kind of thing.
        x: Where it stands, world frame [m].
        y: Where it stands, world frame [m].
        lanes: Names of the lanes in its way, in the order of the town.
    """

    thing: str
    what: str
    x: float
    y: float
    lanes: tuple[str, ...]


def obstructions(town: Town) -> Iterator[Obstruction]:
    """Find poles, signs and objects that a car on a lane runs into.

    Args:
        town: The town.

    Yields:
        Each thing that stands on one or more lanes: lights first, then signs, then objects.
    """
    names = list(town.lanes)
    tree = shapely.STRtree(shapely.buffer(list(lane_polygons(town).values()), -_REACH))
    for thing, what, ground in _grounds(town):
        below = sorted(tree.query(ground, predicate="intersects").tolist())
        if below:
            place = shapely.intersection(ground, tree.geometries[below[0]]).representative_point()
            lanes = tuple(names[index] for index in below)
            yield Obstruction(thing, what, place.x, place.y, lanes)


def _grounds(town: Town) -> Iterator[tuple[str, str, shapely.Geometry]]:
    """Name all that stands, and the ground that it covers."""
    poles = {(light.signal or light.id, *light.pole.tolist()) for light in town.lights.values()}
    for name, x, y in sorted(poles):
        yield name, "light", shapely.Point(x, y).buffer(_THIN)
    for sign in town.signs:
        yield sign.id, "sign", shapely.Point(sign.x, sign.y).buffer(_THIN)
    for thing in town.objects:
        if thing.height > _ON_THE_GROUND:
            yield thing.id, thing.type, _ground(thing)


def _ground(thing: StaticObject) -> shapely.Geometry:
    """Ground that a thing covers; the crown of a tree is above the cars."""
    # What an outline without area leaves are lines, which a buffer of no width drops.
    ground = shapely.buffer(shapely.make_valid(shapely.Polygon(thing.outline)), 0.0)
    is_tree = thing.type == "tree" and not ground.is_empty
    return ground.centroid.buffer(_THIN) if is_tree else ground
