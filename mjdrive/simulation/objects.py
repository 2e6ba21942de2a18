"""Things that the map places: buildings, barriers, poles and trees, as prisms that the car can hit."""

from collections.abc import Sequence

import mujoco
import numpy as np
import shapely

from mjdrive.datatypes import StaticObject
from mjdrive.simulation import palette
from mjdrive.simulation.blocks import DECIMALS, UNSEEN_GROUP
from mjdrive.simulation.facades import Facades
from mjdrive.simulation.greenery import add_trees
from mjdrive.simulation.meshes import Shell
from mjdrive.simulation.walls import walls_along
from mjdrive.town.scenery import ground_of
from mjdrive.town.scenery.blocks import rings
from mjdrive.town.scenery.street_trees import Tree
from mjdrive.vehicle.assembly import OBSTACLE_BITS

TRUNK_SHARE = 0.12  # radius of a trunk over that of the outline of its tree [-]
THINNEST_TRUNK = 0.05  # radius [m]
THINNEST = 0.005  # thinner walls are made thicker by twice as much [m]
TREE, BUILDING = "tree", "building"
BUILDING_COLOR = 0  # number of its wall
MATERIALS = {
    BUILDING: palette.wall(BUILDING_COLOR),
    "pole": "metal",
    "streetLamp": "metal",
    "vegetation": "grass",
}
OTHER_MATERIAL = "concrete"
SMOOTHING = 0.1  # facades leave out corners smaller than this [m]
FILLED = 0.98  # an outline that fills its hull so far counts as convex [-]


def add_objects(
    spec: mujoco.MjSpec, objects: Sequence[StaticObject], *, rng: np.random.Generator
) -> None:
    """Stand the objects of a map.

    Args:
        spec: Scene with the materials of `palette`.
        objects: What stands, not what is painted on the ground.
        rng: Draws how crowns of trees grow.
    """
    placed = [(thing, ground_of([thing.outline])) for thing in objects]
    placed = [(thing, area) for thing, area in placed if not area.is_empty]
    trees = [_as_tree(thing, area) for thing, area in placed if thing.type == TREE]
    add_trees(spec, trees, rng=rng, prefix="object_tree")
    solids = [(thing, area) for thing, area in placed if thing.type != TREE]
    for number, (thing, area) in enumerate(solids):
        for piece, part in enumerate(_convex_parts(area)):
            _add_obstacle(spec, f"object_{number}_{piece}", part, thing.height)
    _show(spec, solids)


def _as_tree(thing: StaticObject, area: shapely.Geometry) -> Tree:
    radius = float(np.sqrt(area.area / np.pi))
    return Tree(
        x=area.centroid.x,
        y=area.centroid.y,
        height=thing.height,
        trunk_radius=max(TRUNK_SHARE * radius, THINNEST_TRUNK),
        crown_radius=min(radius, 0.4 * thing.height),
    )


def _show(spec: mujoco.MjSpec, solids: Sequence[tuple[StaticObject, shapely.Geometry]]) -> None:
    """Show prisms by material; buildings get windows and a roof of their own colour."""
    shells: dict[str, Shell] = {}
    facades = Facades()
    for thing, area in solids:
        sides = shells.setdefault(MATERIALS.get(thing.type, OTHER_MATERIAL), Shell())
        for ring in rings(area):
            sides.fence(ring, bottom=0.0, top=thing.height)
        if thing.type == BUILDING:
            shells.setdefault("gravel", Shell()).area(area, height=thing.height)
            for ring in rings(shapely.simplify(area, SMOOTHING)):
                facades.dress(walls_along(ring[:-1]), thing.height, BUILDING_COLOR, door_share=0.5)
        else:
            sides.area(area, height=thing.height)
    for material, shell in shells.items():
        shell.show(spec, f"placed_{material}", material=material)
    facades.show(spec, "placed_facade")


def _convex_parts(area: shapely.Geometry) -> list[shapely.Polygon]:
    """MuJoCo fills the hollows of a mesh, so hollow outlines are cut."""
    if area.area >= FILLED * area.convex_hull.area:
        return [area.convex_hull]
    return list(shapely.get_parts(shapely.constrained_delaunay_triangles(area)))


def _add_obstacle(spec: mujoco.MjSpec, name: str, part: shapely.Polygon, height: float) -> None:
    contype, conaffinity = OBSTACLE_BITS
    if 2.0 * part.area < THINNEST * part.length:
        # Of what is as thin as paper MuJoCo makes no body.
        part = shapely.buffer(part, THINNEST, join_style="mitre").convex_hull
    outline = shapely.get_coordinates(shapely.orient_polygons(part))[:-1]
    prism = Shell()
    prism.box(outline, bottom=0.0, top=round(height, DECIMALS), floor=True)
    prism.mesh(spec, name)
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=name,
        contype=contype,
        conaffinity=conaffinity,
        group=UNSEEN_GROUP,
    )
