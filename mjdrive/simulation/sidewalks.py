"""Kerbs and sidewalks: raised slabs along the edge of the road."""

from itertools import pairwise

import shapely

from mjdrive.town.scenery.blocks import Block, block_behind, rings
from mjdrive.town.scenery.layout import CHORD_ERROR

KERB_HEIGHT = 0.12  # [m]
SHORTEST_SLAB = 0.05  # [m]
NARROW_DEPTHS = (1.0, 0.15)  # tried where a slab of full depth would reach over another road [m]


def sidewalk_slabs(road: shapely.Geometry, *, width: float) -> list[Block]:
    """Lay slabs along the edge of the road; their front faces are the kerb.

    Args:
        road: Surface between the kerbs, as `town.scenery` lays it out [m].
        width: Width of the sidewalk [m].

    Returns:
        Slabs that leave the road free, in the order of the outline.
    """
    shapely.prepare(road)
    slabs = []
    for ring in rings(road):
        for start, end in pairwise(ring):
            if ((end - start) ** 2).sum() < SHORTEST_SLAB**2:
                continue
            for depth in (width, *NARROW_DEPTHS):
                slab = block_behind(start, end, depth=depth, height=KERB_HEIGHT)
                if not road.intersects(shapely.buffer(slab.footprint(), -CHORD_ERROR)):
                    slabs.append(slab)
                    break
    return slabs
