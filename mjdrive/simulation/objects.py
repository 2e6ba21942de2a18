"""Things that the map places: buildings, barriers, poles and trees, as prisms that the car can hit."""

from collections.abc import Sequence

import mujoco
import numpy as np
import shapely

from mjdrive.datatypes import StaticObject
from mjdrive.simulation.blocks import DECIMALS, UNSEEN_GROUP
from mjdrive.simulation.greenery import add_trees
from mjdrive.simulation.meshes import Shell
from mjdrive.town.blocks import rings
from mjdrive.town.street_trees import Tree
from mjdrive.vehicle.assembly import OBSTACLE_BITS

TRUNK_SHARE = 0.12  # radius of a trunk over that of the outline of its tree [-]
MATERIALS = {"building": "wall_0", "pole": "metal", "streetLamp": "metal", "vegetation": "grass"}
OTHER_MATERIAL = "concrete"
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
    trees = [_as_tree(thing) for thing in objects if thing.type == "tree"]
    add_trees(spec, trees, rng=rng, prefix="object_tree")
    shells: dict[str, Shell] = {}
    others = [thing for thing in objects if thing.type != "tree"]
    for number, thing in enumerate(others):
        area = shapely.Polygon(thing.outline)
        for piece, part in enumerate(_convex_parts(area)):
            _add_obstacle(spec, f"object_{number}_{piece}", part, thing.height)
        shell = shells.setdefault(MATERIALS.get(thing.type, OTHER_MATERIAL), Shell())
        shell.area(area, height=thing.height)
        for ring in rings(area):
            shell.fence(ring, bottom=0.0, top=thing.height)
    for material, shell in shells.items():
        shell.show(spec, f"objects_{material}", material=material)


def _as_tree(thing: StaticObject) -> Tree:
    area = shapely.Polygon(thing.outline)
    radius = float(np.sqrt(area.area / np.pi))
    return Tree(
        x=area.centroid.x,
        y=area.centroid.y,
        height=thing.height,
        trunk_radius=TRUNK_SHARE * radius,
        crown_radius=min(radius, 0.4 * thing.height),
    )


def _convex_parts(area: shapely.Polygon) -> list[shapely.Polygon]:
    """MuJoCo fills the hollows of a mesh, so hollow outlines are cut."""
    if area.area >= FILLED * area.convex_hull.area:
        return [area.convex_hull]
    return list(shapely.get_parts(shapely.constrained_delaunay_triangles(area)))


def _add_obstacle(spec: mujoco.MjSpec, name: str, part: shapely.Polygon, height: float) -> None:
    contype, conaffinity = OBSTACLE_BITS
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
