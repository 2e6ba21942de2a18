"""What lies under the wheels and beside them: asphalt, kerbs, sidewalks, verges and lawns."""

import mujoco
import shapely

from mjdrive.datatypes import Town
from mjdrive.simulation.blocks import DECIMALS, SHOWN_GROUP, UNSEEN_GROUP, add_block
from mjdrive.simulation.meshes import Shell
from mjdrive.simulation.palette import PAVING_SIZE
from mjdrive.simulation.sidewalks import KERB_HEIGHT, sidewalk_slabs
from mjdrive.town.scenery.blocks import rings
from mjdrive.town.scenery.layout import CHORD_ERROR, KERBSTONE_WIDTH, Scenery

LAND_DEPTH = -0.02  # of the lawns below the road [m]
VERGE_SINK = 0.015  # of the grass below the kerbstone [m]


def add_ground(spec: mujoco.MjSpec, town: Town, scenery: Scenery, *, sidewalk_width: float) -> None:
    """Lay the ground; the slabs that tyres feel are unseen, meshes show them without seams.

    Args:
        spec: Scene with the materials of `palette`.
        town: Road network.
        scenery: Its layout.
        sidewalk_width: From the kerb to the far edge of the slabs [m].
    """
    _add_land(spec, town)
    for number, slab in enumerate(sidewalk_slabs(scenery.road, width=sidewalk_width)):
        add_block(spec, f"kerb_{number}", slab, material="kerbstone", group=UNSEEN_GROUP)
    asphalt, paving, grass, kerb = Shell(), Shell(), Shell(), Shell()
    asphalt.area(scenery.road, height=0.0)
    paving.area(scenery.sidewalk, height=KERB_HEIGHT, texture_size=PAVING_SIZE)
    grass.area(scenery.verge, height=KERB_HEIGHT - VERGE_SINK)
    outer = shapely.union_all([scenery.road, scenery.sidewalk, scenery.verge])
    outer = shapely.simplify(
        shapely.buffer(outer, KERBSTONE_WIDTH, join_style="mitre"), CHORD_ERROR
    )
    kerb.area(outer - scenery.road - scenery.sidewalk - scenery.verge, height=KERB_HEIGHT)
    for ring in rings(scenery.road):
        kerb.fence(ring[::-1], bottom=0.0, top=KERB_HEIGHT)
    for ring in rings(outer):
        kerb.fence(ring, bottom=LAND_DEPTH, top=KERB_HEIGHT)
    asphalt.show(spec, "asphalt", material="asphalt")
    paving.show(spec, "sidewalk", material="paving")
    grass.show(spec, "verge", material="grass")
    kerb.show(spec, "kerbstone", material="kerbstone")


def _add_land(spec: mujoco.MjSpec, town: Town) -> None:
    left, bottom, right, top = town.bounds.round(DECIMALS - 1).tolist()
    spec.worldbody.add_geom(
        name="land",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 10],
        pos=[0.5 * (left + right), 0.5 * (bottom + top), LAND_DEPTH],
        contype=0,
        conaffinity=0,
        group=SHOWN_GROUP,
        material="land",
    )
