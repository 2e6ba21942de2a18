"""Things that stand where cars drive."""

from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import shapely

from mjdrive.datatypes import StaticObject, Town
from mjdrive.town.surface import outline

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
    lanes = list(town.lanes.values())
    things = list(_grounds(town))
    if not things:
        return
    # Most lanes have nothing near: outlines are drawn of the others alone.
    tree = shapely.STRtree([shapely.LineString(lane.centerline) for lane in lanes])
    widest = max(lane.width if lane.widths is None else lane.widths.max() for lane in lanes)
    thing_numbers, lane_numbers = tree.query(
        [ground for _, _, ground in things], predicate="dwithin", distance=widest
    )
    near: dict[int, list[int]] = defaultdict(list)
    for thing_number, lane_number in zip(thing_numbers, lane_numbers, strict=True):
        near[int(thing_number)].append(int(lane_number))
    areas = {
        number: shapely.buffer(outline(lanes[number]), -_REACH) for number in set(lane_numbers)
    }
    for number in sorted(near):
        thing, what, ground = things[number]
        below = [n for n in sorted(near[number]) if shapely.intersects(areas[n], ground)]
        if below:
            place = shapely.intersection(ground, areas[below[0]]).representative_point()
            names = tuple(lanes[n].id for n in below)
            yield Obstruction(thing, what, place.x, place.y, names)


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
