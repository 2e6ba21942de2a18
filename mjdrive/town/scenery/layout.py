"""What stands and lies beside the roads, as plain geometry: the one layout that pictures, physics and views share."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float

from mjdrive.datatypes import StaticObject, Town
from mjdrive.town import surface
from mjdrive.town.scenery.blocks import Block
from mjdrive.town.scenery.houses import line_with_houses
from mjdrive.town.scenery.street_trees import Tree, plant_gardens, plant_trees
from mjdrive.town.settings import SceneryConfig

KERBSTONE_WIDTH = 0.15  # [m]
CHORD_ERROR = 0.03  # largest distance between a kerb and the true edge of the road [m]
CORNER = 3.0  # around junctions the sidewalk reaches the kerb [m]
JUNCTION_VIEW = 8.0  # around junctions no tree hides the traffic [m]
CROSSING_RAMP = 1.0  # paving to both sides of a crosswalk, beyond that of a corner [m]
POLE_CLEARANCE = 5.0  # between a tree and a light or a sign [m]
DRIVER_VIEW = 25.0  # a light or a sign is seen from this far [m]
SMALLEST_PATCH = 1.0  # smaller scraps of grass are paved [m^2]
GARDEN_CLEARANCE = 2.5  # between a tree and a house or a sidewalk [m]
SLIVER = 0.4  # so are narrower ones [m]
MANY_PARTS = 1000  # patches of grass or paving [-]
ON_THE_GROUND = 0.05  # objects up to this height are paint [m]
SMALLEST_BLOCK = (
    700.0  # what roads enclose below this area is an island: grass, no sidewalk, no houses [m^2]
)


@dataclass(frozen=True, slots=True, eq=False)
class Scenery:
    """The layout of a town beside its lanes.

    Attributes:
        road: Surface between the kerbs, few corners, world frame [m].
        sidewalk: Paved ground beside the road, kerbstones left out, world frame [m].
        verge: Grass between kerb and sidewalk, as high as the sidewalk, world frame [m].
        buildings: Generated houses; each looks to the left of its yaw, at its street.
        trees: Generated trees.
    """

    road: shapely.Geometry
    sidewalk: shapely.Geometry
    verge: shapely.Geometry
    buildings: tuple[Block, ...]
    trees: tuple[Tree, ...]


def lay_out(town: Town, scenery: SceneryConfig) -> Scenery:
    """Lay out sidewalks, verges, houses and trees; the same town and settings give the same layout.

    Args:
        town: Road network with its signs and objects.
        scenery: Sizes and seed.

    Returns:
        The layout. Houses touch neither road nor sidewalk nor objects of the map.
    """
    rng = np.random.default_rng(scenery.seed)
    road = shapely.simplify(surface.road_surface(town), CHORD_ERROR, preserve_topology=True)
    crossings = _crossings(town)
    sidewalk, verge = _sides(town, road, crossings, scenery)
    objects = ground_of([thing.outline for thing in standing(town)])
    raised = shapely.buffer(road, scenery.sidewalk_width)
    streets = shapely.union_all([raised, sidewalk, verge])
    buildings = line_with_houses(streets, scenery, rng, taken=shapely.buffer(objects, 1.0))
    trees = plant_trees(
        verge,
        scenery,
        rng,
        middle=shapely.buffer(road, 0.5 * (KERBSTONE_WIDTH + scenery.verge_width)),
        keep_clear=shapely.union_all([_views(town, crossings), shapely.buffer(objects, 2.0)]),
    )
    footprints = shapely.union_all([house.footprint() for house in buildings])
    built = shapely.buffer(shapely.union_all([footprints, objects]), GARDEN_CLEARANCE)
    gardens = shapely.buffer(shapely.union_all(_blocks(streets)), -GARDEN_CLEARANCE) - built
    trees += plant_gardens(gardens, scenery, rng)
    return Scenery(road=road, sidewalk=sidewalk, verge=verge, buildings=buildings, trees=trees)


def standing(town: Town) -> tuple[StaticObject, ...]:
    """List the objects of the map that a car can run into; the others lie flat on the ground."""
    return tuple(thing for thing in town.objects if thing.height > ON_THE_GROUND)


def ground_of(outlines: Sequence[Float[np.ndarray, "_ 2"]]) -> shapely.Geometry:
    """Join outlines of a map, which may cross themselves, to the ground that they cover [m]."""
    polygons = shapely.make_valid([shapely.Polygon(outline) for outline in outlines])
    # What outlines without area leave are lines, which a buffer of no width drops.
    return shapely.buffer(shapely.union_all(polygons), 0.0)


def _islands_of(road: shapely.Geometry) -> shapely.Geometry:
    """Ground that the road runs around, too small to build on."""
    return shapely.union_all([hole for hole in _blocks(road) if hole.area < SMALLEST_BLOCK])


def _blocks(area: shapely.Geometry) -> list[shapely.Polygon]:
    """Ground that an area encloses."""
    return [shapely.Polygon(ring) for part in shapely.get_parts(area) for ring in part.interiors]


def _sides(
    town: Town, road: shapely.Geometry, crossings: shapely.Geometry, scenery: SceneryConfig
) -> tuple[shapely.Geometry, shapely.Geometry]:
    """Split the ground beside the kerb into paving and grass."""
    kerb = shapely.buffer(road, KERBSTONE_WIDTH, join_style="mitre")
    ring = shapely.buffer(road, scenery.sidewalk_width)
    paved = ground_of(town.sidewalks)
    verge = shapely.buffer(road, KERBSTONE_WIDTH + scenery.verge_width)
    verge = shapely.difference(verge, shapely.buffer(crossings, CORNER))
    if town.sidewalks:
        corners = shapely.buffer(crossings, CORNER + scenery.sidewalk_width)
        verge = shapely.union_all([verge, shapely.difference(ring, paved) - corners])
    verge = shapely.union_all([verge, _islands_of(road)])
    verge = _without_scraps(shapely.difference(verge, kerb))
    sidewalk = shapely.union_all([ring, paved]) - shapely.union_all([kerb, verge])
    return _without_scraps(sidewalk), verge


def _crossings(town: Town) -> shapely.Geometry:
    """Where people cross: junctions and crosswalks."""
    polygons = surface.lane_polygons(town)
    crossed = [polygons[lane.id] for lane in town.lanes.values() if lane.junction is not None]
    crosswalks = ground_of([thing.outline for thing in town.objects if thing.type == "crosswalk"])
    return shapely.union_all([*crossed, shapely.buffer(crosswalks, CROSSING_RAMP)])


def _views(town: Town, crossings: shapely.Geometry) -> shapely.Geometry:
    """Ground that trees would hide from drivers: junctions, and what lies before lights and signs."""
    lines = [_line_of_sight(light.pole, light.yaw) for light in town.lights.values()]
    lines += [_line_of_sight(np.array([sign.x, sign.y]), sign.yaw) for sign in town.signs]
    sights = shapely.buffer(lines, 0.5 * POLE_CLEARANCE)
    return shapely.union_all([shapely.buffer(crossings, JUNCTION_VIEW), *sights])


def _line_of_sight(spot: Float[np.ndarray, "2"], yaw: float) -> shapely.LineString:
    ahead = DRIVER_VIEW * np.array([np.cos(yaw), np.sin(yaw)])
    return shapely.LineString([spot, spot - ahead])


def _without_scraps(area: shapely.Geometry) -> shapely.Geometry:
    """Drop slivers and small patches."""
    parts = shapely.get_parts(area)
    if len(parts) > MANY_PARTS:
        # Together they would take time that grows with their square; apart they come out in another order.
        kept = shapely.multipolygons(shapely.get_parts(_shrunk(parts)))
    else:
        kept = _shrunk(area)
    wide = shapely.buffer(kept, 0.5 * SLIVER, join_style="mitre")
    parts = shapely.get_parts(shapely.simplify(wide, CHORD_ERROR))
    return shapely.union_all([part for part in parts if part.area >= SMALLEST_PATCH])


def _shrunk(area: shapely.Geometry | np.ndarray) -> shapely.Geometry | np.ndarray:
    return shapely.buffer(area, -0.5 * SLIVER, join_style="mitre")
